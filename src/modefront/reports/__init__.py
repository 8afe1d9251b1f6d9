"""The report: one HTML file with linked views, made of results."""
