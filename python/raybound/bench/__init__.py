"""Measurements of speed, as JSON-ready dictionaries and as tables: `python -m raybound bench base|embree|error`.

`base` measures the base tracer alone, `embree` the base tracer beside Embree, `error` what spawned rays do wrong on
hard cases and what it costs not to; `tables` shows what they return.
"""
