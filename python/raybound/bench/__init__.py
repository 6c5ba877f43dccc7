"""Measurements of speed, as JSON-ready dictionaries and as tables.

`python -m raybound bench base|exact|embree|error|numbers`: `base` measures the base tracer alone, `exact` frames from
kept candidate lists beside it, `embree` the base tracer beside Embree, `error` what spawned rays do wrong on hard cases
and what it costs not to, `numbers` numbers that carry their error; `tables` shows what they return.
"""
