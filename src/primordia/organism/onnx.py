"""Brains in ONNX, which other programs and browsers run (Open Neural Network Exchange, onnx.ai)."""

from pathlib import Path

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from primordia import files
from primordia.errors import InputError
from primordia.law.law import Law
from primordia.law.motor import chosen

OPSET = 26
"""The first set of operators with BitCast, which the sums of some brains need."""
INPUTS, OUTPUTS = ["senses", "memory"], ["action", "memory_after"]


def write(path: Path, law: Law, weights: dict[str, np.ndarray], about: dict[str, str]) -> None:
    """Write a brain as an ONNX model of one tick, with `about` as its metadata.

    The model's inputs are `senses`, float32 (S,), and `memory`, float32 (M,), zero at birth. Its
    outputs are `action`, int32 () or float32 (K,), without the motor's noise, and `memory_after`,
    float32 (M,). A brain without memory has only `senses` and `action`.

    Args:
        path: the file.
        law: the law of the organism's run.
        weights: block of weights -> float32 (*shape).
        about: metadata, name -> value.

    Raises:
        InputError: jax2onnx is not installed, or cannot translate the brain.
        Trouble: the file cannot be written.
    """
    files.check_output(path)
    try:
        from jax2onnx import to_onnx
        from onnx.helper import set_model_props
    except ImportError:
        raise InputError("an ONNX model needs jax2onnx: pip install 'primordia[onnx]'") from None
    lone = {name: jax.device_put(block[None]) for name, block in weights.items()}

    def tick(senses: Array, *memory: Array) -> tuple[Array, ...]:
        before = memory[0] if memory else jnp.zeros(0, jnp.float32)
        after, output = law.brain(lone, before[None], senses[None])
        return chosen(law.action, output, output)[0], *after[: len(memory)]

    shapes = [(law.senses,), (law.memory,)][: 2 if law.memory else 1]
    names = {"input_names": INPUTS[: len(shapes)], "output_names": OUTPUTS[: len(shapes)]}
    try:
        model = to_onnx(tick, shapes, model_name="primordia", opset=OPSET, **names)
    except Exception as error:  # jax2onnx passes on any error of its translators
        kind = type(law.brain).__name__
        raise InputError(f"jax2onnx cannot translate the brain {kind}: {error}") from error
    set_model_props(model, about)
    files.write_bytes(path, model.SerializeToString(deterministic=True))
