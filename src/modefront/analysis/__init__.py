"""Analysis of a front: flat parts, equivalent models, uncertainty."""
