"""Compiled code is kept in, and loaded from, no folder that others can write to."""

import os
import sys
from pathlib import Path

import pytest

from assess.compiled import cache_folder, choose_folder, examine_folder

pytestmark = pytest.mark.skipif(not hasattr(os, "getuid"), reason="access rights of Windows are others")


@pytest.fixture(autouse=True)
def anew():
    examine_folder.cache_clear()
    yield
    examine_folder.cache_clear()


@pytest.fixture
def own(tmp_path, monkeypatch):
    """A user's own folder of caches."""
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "own"))
    monkeypatch.setattr(sys, "platform", "linux")
    return cache_folder()


def made(path: Path, mode: int) -> Path:
    path.mkdir(parents=True, exist_ok=True)
    path.chmod(mode)
    return path


def test_a_folder_that_others_can_write_to_or_replace_is_not_used(tmp_path, own):
    assert choose_folder() == (own, "")
    assert own.stat().st_mode & 0o777 == 0o700, "it is made for the user alone"
    shared, above = tmp_path / "shared", tmp_path / "open"
    inner = made(above / "inner", 0o700)
    (tmp_path / "link").symlink_to(inner)
    (tmp_path / "round").symlink_to(tmp_path / "round")
    for mode in (0o777, 0o702, 0o1777):
        made(shared, mode)
        assert choose_folder(str(shared)) == (own, f"others can write to {shared}")
        own.chmod(mode)
        examine_folder.cache_clear()
        assert choose_folder(str(shared)) == (None, f"others can write to {shared}; others can write to {own}")
        own.chmod(0o700)
        examine_folder.cache_clear()
    above.chmod(0o777)
    for path in (inner, tmp_path / "link"):
        assert choose_folder(str(path)) == (own, f"others can write to {above}")
    above.chmod(0o1777)  # as /tmp: each owns what they make
    examine_folder.cache_clear()
    assert choose_folder(str(inner)) == (inner, "")
    assert "cannot be used" in choose_folder(str(tmp_path / "round"))[1]
    if os.getuid() == 0:  # only root can give files away
        os.chown(made(tmp_path / "theirs", 0o755), 12345, 12345)
        assert choose_folder(str(tmp_path / "theirs"))[1] == f"{tmp_path / 'theirs'} belongs to another user"


def test_what_lies_in_it_counts_where_others_come_in(tmp_path, own):
    named = made(tmp_path / "named", 0o755)
    made(named / "module", 0o777)
    assert choose_folder(str(named)) == (own, f"others can write to {named / 'module'}")
    named.chmod(0o700)
    examine_folder.cache_clear()
    assert choose_folder(str(named)) == (named, "")


def test_the_group_of_one_user_is_no_other(tmp_path, own, monkeypatch):
    grp, pwd = pytest.importorskip("grp"), pytest.importorskip("pwd")
    named, group = made(tmp_path / "named", 0o770), tmp_path.stat().st_gid
    user = pwd.struct_passwd(("ann", "x", os.getuid(), group, "", "", ""))
    monkeypatch.setattr(pwd, "getpwuid", lambda _: user)
    for members, name, is_safe in (
        ([], "ann", True), (["ann"], "ann", True), (["bob"], "ann", False), ([], "all", False),
    ):  # fmt: skip
        monkeypatch.setattr(grp, "getgrgid", lambda _, n=name, m=members: grp.struct_group((n, "x", group, m)))
        examine_folder.cache_clear()
        assert (choose_folder(str(named))[0] == named) is is_safe, (members, name)
