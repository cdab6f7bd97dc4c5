"""Files: what is read, removed and made, and the lines that say why not."""

import errno
import os
from pathlib import Path

import pytest

from primordia import files
from primordia.errors import InputError, Trouble


def test_only_regular_files_up_to_a_size_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A pipe without a writer would be read for ever."""
    pipe, file = tmp_path / "pipe", tmp_path / "file"
    os.mkfifo(pipe)
    file.write_bytes(b"123")
    huge = tmp_path / "huge"
    with huge.open("wb") as out:
        out.truncate(2**26 + 1)
    with pytest.raises(OSError, match="too large"):
        files.read(huge)
    monkeypatch.setattr(files, "READABLE", 3)
    assert files.read(file) == b"123"
    monkeypatch.setattr(files, "READABLE", 2)
    for path, code in (
        *((other, errno.EINVAL) for other in (pipe, tmp_path, Path(os.devnull))),
        (file, errno.EFBIG),
        (tmp_path / "no", errno.ENOENT),
    ):
        with pytest.raises(OSError, match=r"\w") as raised:
            files.read(path)
        assert raised.value.errno == code


def test_a_text_takes_the_place_of_a_link_and_leaves_its_target(tmp_path: Path) -> None:
    target, file = tmp_path / "target", tmp_path / "text"
    target.write_text("mine")
    file.symlink_to(target)
    files.replace_text(file, "one")
    assert (file.read_text(), file.is_symlink(), target.read_text()) == ("one", False, "mine")


def test_a_text_is_written_whether_or_not_its_file_exists(tmp_path: Path) -> None:
    file = tmp_path / "text"
    for text in ("one", "two"):
        files.replace_text(file, text)
        assert (file.read_text(), os.listdir(tmp_path)) == (text, ["text"])


def test_a_file_that_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    path = tmp_path / "no" / "file"
    with pytest.raises(Trouble) as raised:
        files.write_bytes(path, b"")
    assert str(raised.value) == f"{path} cannot be written: No such file or directory"


def test_a_link_is_removed_without_what_it_leads_to(tmp_path: Path) -> None:
    folder, link = tmp_path / "folder", tmp_path / "link"
    folder.mkdir()
    (folder / "file").write_text("kept")
    link.symlink_to(folder)
    files.remove(link)
    assert (folder / "file").read_text() == "kept"
    files.remove(folder)
    assert os.listdir(tmp_path) == []
    with pytest.raises(Trouble) as raised:
        files.remove(link)
    assert str(raised.value) == f"{link} cannot be removed: No such file or directory"


def test_a_folder_is_made_with_its_parents_or_a_line_says_why_not(tmp_path: Path) -> None:
    files.make_folder(tmp_path / "a" / "b")
    files.make_folder(tmp_path / "a" / "b")
    assert (tmp_path / "a" / "b").is_dir()
    (tmp_path / "file").touch()
    with pytest.raises(
        InputError, match="b is not a folder, or leads through a file; name another"
    ):
        files.make_folder(tmp_path / "file" / "b")
    for name in ("a\0b", "a\udcff"):
        with pytest.raises(InputError, match="choose another name"):
            files.make_folder(tmp_path / name)
    longest = "é" * (files.LONGEST_NAME // 2)
    files.make_folder(tmp_path / longest)
    files.write_text(tmp_path / longest / longest, "short enough")
    with pytest.raises(InputError, match="is too long; give a shorter one"):
        files.make_folder(tmp_path / (longest + "e"))


def test_each_new_folder_is_waited_for_in_its_parent(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After a power cut a folder is there only if its name in the folder around it was synced."""
    synced: list[tuple[Path, bool]] = []
    folders = [tmp_path / "a", tmp_path / "a" / "b", tmp_path / "a" / "b" / "c"]
    monkeypatch.setattr(files, "sync", lambda path: synced.append((path, last(path).is_dir())))

    def last(parent: Path) -> Path:
        return next(each for each in folders if each.parent == parent)

    files.make_folder(folders[-1])
    assert {*synced} == {(each.parent, True) for each in folders}


def test_each_fault_of_a_sealed_file_is_named(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"abc")
    sealed = files.seal(file)
    assert files.fault_in(file, sealed["bytes"], sealed["sha256"]) is None
    file.write_bytes(b"abd")
    assert "checksum" in str(files.fault_in(file, sealed["bytes"], sealed["sha256"]))
    for content in (b"", b"ab", b"abcd"):
        file.write_bytes(content)
        says = f"{file} has {len(content)} bytes instead of 3"
        assert files.fault_in(file, sealed["bytes"], sealed["sha256"]) == says
    file.unlink()
    assert "is missing" in str(files.fault_in(file, sealed["bytes"], sealed["sha256"]))


def test_a_mark_is_made_once(tmp_path: Path) -> None:
    files.mark(tmp_path / "mark")
    assert (tmp_path / "mark").read_bytes() == b""
    with pytest.raises(Trouble, match=r"mark cannot be written: File exists$"):
        files.mark(tmp_path / "mark")


def test_the_name_of_a_folder_in_a_path_is_checked_too(tmp_path: Path) -> None:
    longest = "é" * (files.LONGEST_NAME // 2)
    files.check_name(tmp_path / longest / "file")
    with pytest.raises(InputError, match=f"^the file name {longest[:40]}... is too long"):
        files.check_name(tmp_path / (longest + "e") / "file")


def test_only_a_free_path_or_a_folder_is_a_folder_of_a_run(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "link").symlink_to("folder")
    for name in ("folder", "new"):
        files.check_own_folder(tmp_path / name)
        files.own_folder(tmp_path / name)
        assert (tmp_path / name).is_dir()
    with pytest.raises(
        InputError, match="link is a symbolic link, not a folder; a run writes only"
    ):
        files.check_own_folder(tmp_path / "link")
