"""Study files whose tables are wrong, or that are none."""

from pathlib import Path

import pytest
from faultless import DATA, GROUPS, PARAMETERS, STUDY, WEIGHTED
from refusals import Check, command, edited, refuses

pytestmark = pytest.mark.usefixtures("short_chains")

CONTRADICTIONS = [
    # tables
    ("[study]\n", "[stduy]\n", "top level: expected a known key, found 'stduy' (did you mean 'st"),
    ("[study]\n", "[stduy]\n", "study: expected a table [study], found nothing"),
    ("[study]\n", "[[study]]\n", "study: expected a table [study], found a list of 1"),
    ("[data]\n", "[dat]\n", "data: expected a table [data], found nothing"),
    ("[data]\n", "[[data]]\n", "data: expected a table [data], found a list of 1"),
    ("[model]\n", "[modell]\n", "model: expected a table [model], found nothing"),
    ("[model]\n", "[[model]]\n", "model: expected a table [model], found a list of 1"),
    (PARAMETERS, "", "parameter: expected at least one table [[parameter]], found nothing"),
    (PARAMETERS, "[parameter]\n", "parameter: expected at least one table ... found a table"),
    (GROUPS, "", "group: expected at least one table [[group]], found nothing"),
    (GROUPS, "[group]\n", "group: expected at least one table [[group]], found a table"),
    ("[study]\n", "group = 1\n[study]\n", "file: expected TOML in UTF-8, found "),
    (WEIGHTED, "[weighted]\n", "weighted: expected tables [[weighted]], found a table"),
    ("[pareto]", "[[pareto]]", "pareto: expected a table, found a list of 1"),
    ("[pareto]", "[paretto]", "expected a known key, found 'paretto' (did you mean 'pareto'?)"),
    ("[pairing]", "[pair]", "expected a known key, found 'pair' (did you mean 'pairing'?)"),
    ("[search]", "[research]", "expected a known key, found 'research' (did you mean 'search'?)"),
    ("[identifiability]", "[identifiable]", "found 'identifiable' (did you mean 'identifiabil"),
    ("[uncertainty]", "[[uncertainty]]", "uncertainty: expected a table, found a list of 1"),
    ("[uncertainty]", "[certainty]", "found 'certainty' (did you mean 'uncertainty'?)"),
    # files
    ("modes.csv", "absent.csv", "absent.csv: file: expected a file of modal data, found no such"),
    ("modes.csv", "folder.csv", "folder.csv: file: expected a file of modal data, found a folder"),
    (
        "modes.csv",
        "modes.xls",
        "[data] file: expected a file that ends in .csv, .uff or .unv, found 'modes.xls'",
    ),
    # what is no TOML
    ("[study]", "[study", "file: expected TOML in UTF-8, found ... line "),
    ("seed = 1", "seed =", "file: expected TOML in UTF-8, found ... line "),
    ("seed = 1", "seed = 1\nseed = 2", "file: expected TOML in UTF-8, found ... line "),
    ("[pareto]", "[study]", "file: expected TOML in UTF-8, found ... line "),
    ("seed = 1", f"seed = {'9' * 5000}", "file: expected TOML in UTF-8, found "),
    ("seed = 1", f"seed = {'[' * 20000}", "file: expected TOML in UTF-8, found "),
]


test_contradictions_of_tables_and_files = refuses(*CONTRADICTIONS)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "file: expected a study file, found an empty file"),
        (b"# nothing", "study: expected a table [study], found nothing"),
        (b"# nothing", "parameter: expected at least one table [[parameter]], found nothing"),
        (b"\xff\xfe\x00", "file: expected TOML in UTF-8, found the byte 0xff at position 0"),
        (STUDY.encode("utf-16"), "file: expected TOML in UTF-8, found "),
        (b"\x00" * 100, "file: expected TOML in UTF-8, found "),
        (b"PK\x03\x04\x14\x00", "file: expected TOML in UTF-8, found "),
    ],
)
def test_files_that_are_no_study(content: bytes, says: str, folder: Path, refused: Check) -> None:
    study = folder / "wrong.toml"
    study.write_bytes(content)
    refused(study, f"wrong.toml: {says}")


def test_a_study_that_is_not_there_or_a_folder(folder: Path, refused: Check) -> None:
    refused(folder / "absent.toml", "absent.toml: file: expected a study file, found no such file")
    refused(folder / "folder.mtx", "folder.mtx: file: expected a study file, found a folder")


def test_a_byte_order_mark_and_other_line_ends_change_nothing(folder: Path) -> None:
    (folder / "windows.toml").write_bytes(b"\xef\xbb\xbf" + STUDY.replace("\n", "\r\n").encode())
    quoted = DATA.replace("low,", '"low",').replace("a,2", '"a","2"').replace("\n", "\r\n")
    (folder / "modes.csv").write_bytes(b"\xef\xbb\xbf" + quoted.encode())
    assert command("check", folder / "windows.toml") == 0


def test_everything_that_is_wrong_is_said_at_once_before_a_run_and_by_check(
    folder: Path, refused: Check, capsys: pytest.CaptureFixture[str]
) -> None:
    study = folder / "wrong.toml"
    edits = [
        ("seed = 1", "seed = -1"),
        ("[2.0, 1.0]", "[2.0, -1.0]"),
        ("low = 0", "low = 1.5"),
        ("bounds = [0.2, 5.0]", "bounds = [5.0, 0.2]"),
        ("shape = [1, 2]", "shape = [1, 7]"),
        ("shapes = 2.0", "shapes = -2.0"),
        ("points = 5", "points = 1"),
        ("window = 3.0", "window = 0.5"),
        ("doubt = 0.4", "doubts = 0.4"),
    ]
    study.write_text(edited(STUDY, *edits))
    (folder / "modes.csv").write_text(
        edited(DATA, ("4.0", "-4.0"), ("11.0", "eleven"), ("0.02", "2"))
    )
    refused(
        study,
        "wrong.toml: [study] seed: ",
        "wrong.toml: [model] masses: ",
        "wrong.toml: [model] sensors low: ",
        "wrong.toml: [[parameter]] 1 ('k1') bounds: ",
        "modes.csv: line 2, column 'frequency': ",
        "modes.csv: line 3, column 'frequency': ",
        "modes.csv: line 4, column 'damping': ",
        "wrong.toml: [[weighted]] 1 ('mine') weights shapes: ",
        "wrong.toml: [pareto] points: ",
        "wrong.toml: [pairing] window: ",
        "wrong.toml: [search]: expected a known key, found 'doubts'",
    )
    command("run", study)
    text = capsys.readouterr().err
    assert command("check", study) == 2
    assert capsys.readouterr() == ("", text)


@pytest.mark.slow(6)
def test_names_may_hold_what_a_path_or_a_terminal_gives_a_meaning(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    study = folder / "names.toml"
    text = STUDY.replace('"k1"', '"../k/1 [red]"').replace('"k2"', '"%s"')
    text = text.replace('"frequencies"', '"a/b [bold]"').replace("{ frequencies", '{ "a/b [bold]"')
    text = text.replace('"mine"', '"../[/]"').replace('"two masses"', '"[/] ${x}"')
    text = text.replace('"low"', '"[/low]"').replace("low = ", '"[/low]" = ')
    study.write_text(text.replace('"peak"', '"../[/peak] $_"'))
    (folder / "modes.csv").write_text(DATA.replace("low", "[/low]"))
    assert command("check", study) == 0, capsys.readouterr().err
    assert "a/b [bold]" in capsys.readouterr().out
    assert command("run", study, "-o", folder / "output") == 0, capsys.readouterr().err
    assert command("show", folder / "output", "--all") == 0, capsys.readouterr().err
    out = capsys.readouterr().out
    assert "../k/1 [red]" in out
    assert "../[/]" in out
    assert "../[/peak] $_: force at top" in out
    assert command("show", folder / "output", "--figures") == 0, capsys.readouterr().err
    assert not (folder / "k").exists()
