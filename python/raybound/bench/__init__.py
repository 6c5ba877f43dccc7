"""Measurements of speed, as JSON-ready dictionaries and as tables: `python -m raybound bench base|embree`.

`base` measures the base tracer alone, `embree` the base tracer beside Embree; `tables` shows what they return.
"""
