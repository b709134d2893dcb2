"""Helpers of numerical work: cubics, means of large fields, what lies between cells, transforms, values kept for reuse.

Knows arrays, and a grid where cells have a size; nothing of mechanics. One subject a module, imported from there.
Verified in tests/numerics/, tests/test_transforms.py and tests/frugality/test_allocations.py.
"""
