"""Parts that the study files of tests have in common."""


def two_of_each(least: float = 0.2, most: float = 5.0) -> str:
    """Return the tables of parameters k1 and k2, and of all frequencies and all shapes."""
    parameters = [
        f'[[parameter]]\nname = "{name}"\nnominal = 1.0\nbounds = [{least}, {most}]\n'
        for name in ("k1", "k2")
    ]
    groups = [
        f'[[group]]\nname = "{name}"\n{kind} = "all"\n'
        for name, kind in (("frequencies", "frequency"), ("shapes", "shape"))
    ]
    return "\n".join([*parameters, *groups])
