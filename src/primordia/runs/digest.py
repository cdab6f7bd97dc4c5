"""Digests: equal runs have equal digests, however they were computed and stored.

Records enter as a sum of row hashes. So a digest can be updated as its run goes on, and does not depend
on the order of rows, chunks or segments. The state enters byte by byte, without its empty cells.
"""

import hashlib
from collections.abc import Mapping

import numpy as np

from primordia.settings.islands import Islands

LANES = (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F)
BLOCK = 65536


def row_hashes(rows: np.ndarray) -> np.ndarray:
    """Return a hash of 128 bits for each row: uint64 (n, 2) from uint32 (n, fields).

    Each word is mixed in by the finaliser of MurmurHash3 (Appleby 2011).
    """
    hashes = np.empty((len(rows), len(LANES)), np.uint64)
    for lane, start in enumerate(LANES):
        h = np.full(len(rows), start, np.uint64)
        for column in rows.T:
            h = _mix(h ^ column.astype(np.uint64)) * np.uint64(start)
        hashes[:, lane] = _mix(h)
    return hashes


def _mix(h: np.ndarray) -> np.ndarray:
    h = (h ^ (h >> np.uint64(33))) * np.uint64(0xFF51AFD7ED558CCD)
    h = (h ^ (h >> np.uint64(33))) * np.uint64(0xC4CEB9FE1A85EC53)
    return h ^ (h >> np.uint64(33))


def digests(
    records: dict[str, np.ndarray],
    arrays: Mapping[str, np.ndarray],
    worlds: int,
    islands: Islands,
) -> list[str]:
    """Return the digest of each world, hexadecimal.

    Args:
        records: the sums of row hashes of each table, uint64 (W, 2).
        arrays: the state by name, first axis worlds or cells; open tails are left out.
        worlds: number of worlds W.
        islands: the islands of a world.
    """
    state = {name: arrays[name] for name in arrays if not name.startswith("tail.")}
    return [_world_digest(records, state, world, worlds, islands) for world in range(worlds)]


def _world_digest(
    records: dict[str, np.ndarray],
    arrays: dict[str, np.ndarray],
    world: int,
    worlds: int,
    islands: Islands,
) -> str:
    digest = hashlib.sha256()
    for name in sorted(records):
        digest.update(records[name][world].astype("<u8").tobytes())
    alive = np.asarray(arrays["world.organisms.alive"]).reshape(worlds, -1)[world]
    for name in sorted(arrays):
        digest.update(name.encode())
        array = arrays[name]
        if name.startswith("world.worlds."):
            digest.update(np.ascontiguousarray(array[world]).tobytes())
            continue
        cells = islands.with_rows(name)
        mine = array[world * len(cells) : (world + 1) * len(cells)]
        here = alive[cells.start : cells.stop]
        for start in range(0, len(cells), BLOCK):
            living = mine[start : start + BLOCK][here[start : start + BLOCK]]
            digest.update(np.ascontiguousarray(living).tobytes())
    digest.update(np.packbits(alive).tobytes())
    return digest.hexdigest()
