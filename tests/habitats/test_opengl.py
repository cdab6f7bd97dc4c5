"""The library with which pictures of robots are drawn."""

import pytest

pytest.importorskip("mujoco")

from primordia.habitats import opengl


@pytest.mark.parametrize(
    ("chosen", "library", "backend"),
    [("glfw", "osmesa.so", "glfw"), ("", "osmesa.so", "osmesa"), ("", None, "egl"),
     ("osmesa", None, "osmesa")],
)  # fmt: skip
def test_pictures_are_drawn_without_a_screen_unless_the_user_chooses(
    chosen: str, library: str | None, backend: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(opengl, "find_library", lambda name: {"OSMesa": library}[name])
    monkeypatch.setenv(opengl.VARIABLE, chosen)
    assert opengl.backend() == backend
