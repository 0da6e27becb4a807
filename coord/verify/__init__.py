"""The independent checker: standard library only, imports nothing of coord.

It reads the bytes of a plan file and decides by exact or interval arguments, never by samples.
"""

from __future__ import annotations

from coord.verify.check import verify
from coord.verify.report import Clearance, Finding, Report

__all__ = ["Clearance", "Finding", "Report", "verify"]
