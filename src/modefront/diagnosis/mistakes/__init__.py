"""Kinds of mistakes; `modefront.diagnosis.search` names all that are looked for."""
