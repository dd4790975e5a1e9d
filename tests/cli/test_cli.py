#!/usr/bin/env python3
"""Runs all tests of the program; MSKIT names it, MSKIT_SHARED the folder of the shared data.

    MSKIT=build/eval/mskit tests/cli/test_cli.py [-v] [-k PATTERN]
"""
import os
import sys
import unittest

FOLDER = os.path.dirname(os.path.abspath(__file__))


def load_tests(loader, _tests, _pattern):
    return loader.discover(FOLDER, pattern="cases_*.py")


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    sys.path.insert(0, FOLDER)
    unittest.main()
