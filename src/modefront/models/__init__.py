"""Classes of models: the modes at sensors as a function of parameters."""
