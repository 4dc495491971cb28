from __future__ import annotations

import os
from pathlib import Path

import pytest

from linkwright.designs.language.errors import ReleaseError
from linkwright.exports.folder import prove_writable, whole_folder


def names_in(folder):
    return sorted(path.name for path in folder.iterdir())


def ours(folder):
    return (folder / "mark").exists()


def write(out, text="new"):
    with whole_folder(out, ours) as draft:
        (draft / "mark").write_text(text)


def test_folder_appears_whole_with_its_parents(tmp_path):
    write(tmp_path / "a" / "b" / "out")
    assert (tmp_path / "a" / "b" / "out" / "mark").read_text() == "new"
    assert names_in(tmp_path / "a" / "b") == ["out"]


def test_folder_is_not_there_before_the_block_ends(tmp_path):
    with whole_folder(tmp_path / "out", ours) as draft:
        (draft / "mark").write_text("new")
        assert not (tmp_path / "out").exists()
        assert draft.parent == tmp_path


@pytest.mark.parametrize("error", [ValueError("x"), KeyboardInterrupt(), OSError(28, "No space left on device")])
def test_folder_leaves_nothing_when_the_block_fails(tmp_path, error):
    with (
        pytest.raises((ValueError, KeyboardInterrupt, ReleaseError)),
        whole_folder(tmp_path / "a" / "out", ours) as draft,
    ):
        (draft / "half").write_text("half")
        raise error
    assert names_in(tmp_path) == []


def test_folder_that_runs_out_of_space_says_so(tmp_path):
    with pytest.raises(ReleaseError, match="No space left"), whole_folder(tmp_path / "out", ours):
        raise OSError(28, "No space left on device")


def test_older_folder_stays_when_the_block_fails(tmp_path):
    write(tmp_path / "out", "old")
    with pytest.raises(ValueError, match="x"), whole_folder(tmp_path / "out", ours) as draft:
        (draft / "mark").write_text("new")
        raise ValueError("x")
    assert (tmp_path / "out" / "mark").read_text() == "old"
    assert names_in(tmp_path) == ["out"]


def test_older_folder_is_replaced_and_none_of_its_files_stays(tmp_path):
    write(tmp_path / "out", "old")
    (tmp_path / "out" / "extra").write_text("old")
    write(tmp_path / "out")
    assert names_in(tmp_path / "out") == ["mark"]
    assert (tmp_path / "out" / "mark").read_text() == "new"
    assert names_in(tmp_path) == ["out"]


def test_older_folder_comes_back_when_the_new_one_cannot_be_renamed_in(tmp_path, monkeypatch):
    write(tmp_path / "out", "old")
    rename = Path.rename

    def failing(self, target):
        if self.name.endswith(".draft"):
            raise OSError(5, "Input/output error")
        return rename(self, target)

    monkeypatch.setattr(Path, "rename", failing)
    with pytest.raises(ReleaseError, match="Input/output error"):
        write(tmp_path / "out")
    assert (tmp_path / "out" / "mark").read_text() == "old"
    assert names_in(tmp_path) == ["out"]


def test_empty_folder_is_filled(tmp_path):
    (tmp_path / "out").mkdir()
    write(tmp_path / "out")
    assert (tmp_path / "out" / "mark").read_text() == "new"


def test_foreign_folder_is_refused_and_untouched(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.tex").write_text("years of work")
    with pytest.raises(ReleaseError, match="no release has written"):
        write(tmp_path / "out")
    assert names_in(tmp_path / "out") == ["thesis.tex"]
    assert names_in(tmp_path) == ["out"]


def test_file_in_the_way_is_refused(tmp_path):
    (tmp_path / "out").write_text("x")
    with pytest.raises(ReleaseError, match="is a file"):
        write(tmp_path / "out")


def test_place_below_a_file_is_refused(tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(ReleaseError, match="cannot be written"):
        write(tmp_path / "file" / "out")


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="needs a place that even root cannot write")
def test_place_that_nobody_can_write_is_refused():
    with pytest.raises(ReleaseError, match="/proc/linkwright cannot be written"):
        write(Path("/proc/linkwright"))


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root writes everywhere")
def test_folder_without_permission_is_refused(tmp_path):
    tmp_path.chmod(0o555)
    try:
        with pytest.raises(ReleaseError, match="Permission denied"):
            write(tmp_path / "out")
    finally:
        tmp_path.chmod(0o755)


def test_link_to_an_older_folder_stays_a_link(tmp_path):
    write(tmp_path / "real", "old")
    (tmp_path / "out").symlink_to(tmp_path / "real")
    write(tmp_path / "out")
    assert (tmp_path / "out").is_symlink()
    assert (tmp_path / "real" / "mark").read_text() == "new"


def test_proof_that_a_place_can_be_written_leaves_nothing(tmp_path):
    prove_writable(tmp_path / "a" / "b" / "out")
    assert names_in(tmp_path) == []
    write(tmp_path / "out", "old")
    prove_writable(tmp_path / "out")
    assert (tmp_path / "out" / "mark").read_text() == "old"
    assert names_in(tmp_path) == ["out"]


def test_proof_fails_where_nothing_can_be_written(tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(ReleaseError, match="cannot be written"):
        prove_writable(tmp_path / "file" / "a" / "out")
    assert names_in(tmp_path) == ["file"]
