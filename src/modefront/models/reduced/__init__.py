"""Reduced bases that certify themselves: from a few full eigensolutions to all the others."""
