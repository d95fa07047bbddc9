"""Tests of the evaluation report: python3 -m unittest discover -s scripts/report/tests -t scripts"""
