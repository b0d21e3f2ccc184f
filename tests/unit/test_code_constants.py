"""The constants of our code are read once, before the processes that run property tests begin."""

from hypothesis import configuration
from hypothesis.internal import constants_ast

from tools import code_constants


def test_hypothesis_takes_the_constants_that_were_read_and_reads_no_file_again(
    tmp_path, monkeypatch
):
    monkeypatch.setattr(configuration, "__hypothesis_home_directory", tmp_path)
    monkeypatch.setattr(code_constants, "ROOT", tmp_path)
    read, parsed = constants_ast._constants_from_source, []
    monkeypatch.setattr(
        constants_ast,
        "_constants_from_source",
        lambda text, *, limit: (parsed.append(text), read(text, limit=limit))[1],
    )
    source = tmp_path / "recon4" / "limits.py"
    source.parent.mkdir()
    source.write_text("MOST = 417_318\n")

    code_constants.main()
    code_constants.main()

    first, second = parsed
    assert first == source.read_bytes()
    assert second.startswith(b"# file: ") and b"417318" in second
