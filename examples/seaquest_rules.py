"""The rules of MinAtar's Seaquest (Young & Tian 2019) in JAX.

They are those of MinAtar 1.0.15 (a program under the GPL, which is not needed here), tick by tick;
`tests/test_seaquest.py` compares the two. In each group the newest thing has slot 0, and pushes the
oldest one out. That one has then left the screen, together with the last bullet that it shot, since there
are slots enough.
"""

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

SIDE, FLOOR = 10, 8
"""cells of a side of the screen, and the lowest row of the sea"""
OXYGEN, ABOARD = 200, 6
"""ticks under water, and divers on board, at most"""
SPAWN, MOVE = 20, 5
"""ticks from one enemy to the next, and ticks in which an enemy waits between moves, in the beginning"""
DIVER_SPAWN, DIVER_MOVE, COOL_DOWN, ENEMY_SHOT = 30, 5, 5, 10
"""ticks from one diver to the next; waits of divers, of the player's gun, and of an enemy's gun"""
SHOTS, ENEMIES, DIVERS = 4, 40, 3
"""slots; at the fastest an enemy comes in each tick and leaves after 30, its last bullet 10 later"""
LEFT, UP, RIGHT, DOWN, FIRE = range(1, 6)


class Shots(NamedTuple):
    """The player's bullets, each (SHOTS,)."""

    there: Any
    x: Any
    y: Any
    right: Any


class Enemies(NamedTuple):
    """Fish and submarines, each (ENEMIES,). A submarine has at most one bullet on the screen."""

    there: Any
    x: Any
    y: Any
    right: Any
    armed: Any
    wait: Any
    reload: Any
    bullet: Any
    """bool: its bullet is on the screen, perhaps longer than itself"""
    bullet_x: Any


class Divers(NamedTuple):
    """Divers, each (DIVERS,)."""

    there: Any
    x: Any
    y: Any
    right: Any
    wait: Any


class State(NamedTuple):
    """A game. The submarine is at `x` and `y`; row 0 is the surface."""

    x: Array
    y: Array
    right: Array
    oxygen: Array
    aboard: Array
    """divers on board; as in MinAtar -1 when six were brought up at once, and then less each time"""
    surfaced: Array
    reload: Array
    enemy_wait: Array
    diver_wait: Array
    spawn: Array
    move: Array
    ramp: Array
    shots: Shots
    enemies: Enemies
    divers: Divers


class Draws(NamedTuple):
    """What chance decides in a tick: where an enemy and a diver come from, if one is due."""

    enemy_right: Any
    enemy_armed: Any
    enemy_row: Any
    diver_right: Any
    diver_row: Any


def draws(key: Any) -> Draws:
    """Return the draws of a tick."""
    word = jax.random.bits(key)
    rows = 1 + (word % 8), 1 + (word // 8 % 8)
    enemy_row, diver_row = (row.astype(jnp.int32) for row in rows)
    return Draws(
        enemy_right=word // 64 % 2 == 0,
        enemy_armed=word // 256 % 3 == 0,
        enemy_row=enemy_row,
        diver_right=word // 128 % 2 == 0,
        diver_row=diver_row,
    )


def first() -> State:
    """Return a game's first state."""

    def none(kind: Any, slots: int) -> Any:
        flags = ("there", "right", "armed", "bullet")
        return kind(*(jnp.zeros(slots, bool if f in flags else jnp.int32) for f in kind._fields))

    waits = {"reload": 0, "enemy_wait": SPAWN, "diver_wait": DIVER_SPAWN}
    levels = {"spawn": SPAWN, "move": MOVE, "ramp": 0}
    numbers = {"x": 5, "y": 0, "oxygen": OXYGEN, "aboard": 0, **waits, **levels}
    return State(
        **{name: jnp.int32(number) for name, number in numbers.items()},
        right=jnp.bool_(False),
        surfaced=jnp.bool_(True),
        shots=none(Shots, SHOTS),
        enemies=none(Enemies, ENEMIES),
        divers=none(Divers, DIVERS),
    )


def tick(state: State, action: Array, drawn: Draws) -> tuple[State, Array, Array]:
    """Return the state after a tick, the points of the tick, and whether the game is over."""
    state = _steered(_spawned(state, drawn), action)
    state, points = _shots_fly(state)
    state = _divers_move(state)
    state, more, killed = _enemies_move(state)
    state, delivered, over = _breathe(state)
    return state, points + more + delivered, killed | over


def _spawned(state: State, drawn: Draws) -> State:
    """Let a diver and an enemy come in, if due; no enemy comes in against another one in its row."""
    due, others = state.enemy_wait == 0, state.enemies
    against = others.there & (others.y == drawn.enemy_row) & (others.right != drawn.enemy_right)
    enemy = Enemies(
        there=True,
        x=_start(drawn.enemy_right),
        y=drawn.enemy_row,
        right=drawn.enemy_right,
        armed=drawn.enemy_armed,
        wait=state.move,
        reload=ENEMY_SHOT,
        bullet=False,
        bullet_x=0,
    )
    diver_due, right = state.diver_wait == 0, drawn.diver_right
    diver = Divers(True, _start(right), drawn.diver_row, right, DIVER_MOVE)
    return state._replace(
        enemies=_pushed(due & ~against.any(), enemy, others),
        enemy_wait=jnp.where(due, state.spawn, state.enemy_wait),
        divers=_pushed(diver_due, diver, state.divers),
        diver_wait=jnp.where(diver_due, DIVER_SPAWN, state.diver_wait),
    )


def _start(right: Any) -> Any:
    """Return the column in which something that moves right, or else left, comes in."""
    return jnp.where(right, 0, SIDE - 1)


def _pushed(comes: Array, new: Any, group: Any) -> Any:
    """Return a group with a new thing in slot 0, if it comes."""

    def push(value: Any, slots: Array) -> Array:
        value = jnp.asarray(value, slots.dtype)
        return jnp.where(comes, jnp.concatenate([value[None], slots[:-1]]), slots)

    return jax.tree.map(push, new, group)


def _steered(state: State, action: Array) -> State:
    """Let the player move or shoot."""
    fires = (action == FIRE) & (state.reload == 0)
    shot = Shots(True, state.x, state.y, state.right)
    across = (action == RIGHT).astype(jnp.int32) - (action == LEFT)
    along = (action == DOWN).astype(jnp.int32) - (action == UP)
    return state._replace(
        shots=_pushed(fires, shot, state.shots),
        reload=jnp.where(fires, COOL_DOWN, state.reload),
        x=jnp.clip(state.x + across, 0, SIDE - 1),
        y=jnp.clip(state.y + along, 0, FLOOR),
        right=jnp.where(across == 0, state.right, across > 0),
    )


def ahead(x: Array, right: Array, moves: Array) -> Array:
    """Return columns a cell further to the right, or else left, where something moves."""
    return x + jnp.where(moves, jnp.where(right, 1, -1), 0)


def on_screen(x: Array) -> Array:
    """Return whether columns, or rows, are on the screen."""
    return (x >= 0) & (x < SIDE)


def _shots_fly(state: State) -> tuple[State, Array]:
    """Let the player's bullets fly; the newest hits first, and fish before submarines."""
    shots, enemies = state.shots, state.enemies
    x = ahead(shots.x, shots.right, shots.there)
    shots = shots._replace(x=x, there=shots.there & on_screen(x))
    slots = jnp.arange(ENEMIES) + ENEMIES * ~enemies.armed
    return _hits(state, shots, enemies, enemies.there, slots, range(SHOTS))


def _hits(
    state: State, shots: Shots, enemies: Enemies, exposed: Array, rank: Array, order: Any
) -> tuple[State, Array]:
    """Let each bullet hit, of the exposed enemies in its cell, the one with the highest rank."""
    there, flying, points = enemies.there, shots.there, jnp.int32(0)
    for shot in order:
        in_cell = (enemies.x == shots.x[shot]) & (enemies.y == shots.y[shot])
        found = in_cell & there & exposed & flying[shot]
        there &= ~(found & (rank == jnp.where(found, rank, -1).max()))
        flying = flying.at[shot].set(flying[shot] & ~found.any())
        points += found.any()
    shots, enemies = shots._replace(there=flying), enemies._replace(there=there)
    return state._replace(shots=shots, enemies=enemies), points


def _divers_move(state: State) -> State:
    """Let divers move; the submarine takes those that it touches, the newest first, if they fit."""
    divers, aboard = state.divers, state.aboard
    due = divers.wait == 0
    before = _touched(state, divers)
    x = ahead(divers.x, divers.right, due)
    after = due & _touched(state, divers._replace(x=x))
    there = divers.there & (~due | on_screen(x))
    taken = []
    for diver in range(DIVERS):
        takes = (before | after)[diver] & (aboard < ABOARD)
        aboard += takes
        taken.append(takes)
    there &= ~jnp.stack(taken)
    wait = jnp.where(due, DIVER_MOVE, divers.wait - 1)
    return state._replace(divers=divers._replace(x=x, wait=wait, there=there), aboard=aboard)


def _touched(state: State, group: Any) -> Array:
    """Return which of a group are in the submarine's cell."""
    return group.there & (group.x == state.x) & (group.y == state.y)


def _enemies_move(state: State) -> tuple[State, Array, Array]:
    """Let enemies and their bullets move; return the points, and whether the player is killed."""
    enemies = state.enemies
    due, touched = enemies.there & (enemies.wait == 0), _touched(state, enemies)
    x = ahead(enemies.x, enemies.right, due)
    shoots = enemies.there & enemies.armed & (enemies.reload == 0)
    bullet_x = jnp.where(shoots, x, enemies.bullet_x)
    bullet = enemies.bullet | shoots
    in_row = enemies.y == state.y
    hit = bullet & in_row & (bullet_x == state.x)
    bullet_x = ahead(bullet_x, enemies.right, bullet)
    hit |= bullet & in_row & (bullet_x == state.x)
    moved = enemies._replace(
        x=x,
        there=enemies.there & (~due | on_screen(x)),
        wait=jnp.where(due, state.move, enemies.wait - 1),
        reload=jnp.where(shoots, ENEMY_SHOT, enemies.reload - 1),
        bullet=bullet & on_screen(bullet_x),
        bullet_x=bullet_x,
    )
    reached = _touched(state, moved)
    newest = ENEMIES - jnp.arange(ENEMIES) + ENEMIES * moved.armed
    oldest_first = reversed(range(SHOTS))
    state, points = _hits(state, state.shots, moved, due & ~reached, newest, oldest_first)
    return state, points, (touched | reached | hit).any()


def _breathe(state: State) -> tuple[State, Array, Array]:
    """Shorten waits; use oxygen, or fill the tank at the surface; return points and if it is over."""
    under, over = state.y > 0, state.oxygen <= 0
    comes_up = ~under & ~state.surfaced
    over |= comes_up & (state.aboard == 0)
    comes_up &= state.aboard != 0
    full = state.aboard == ABOARD
    points = jnp.where(comes_up & full, state.oxygen * 10 // OXYGEN, 0)
    harder = comes_up & ((state.spawn > 1) | (state.move > 2))
    faster = harder & (state.move > 2) & (state.ramp % 2 == 1)
    state = state._replace(
        oxygen=jnp.where(comes_up, OXYGEN, state.oxygen - under),
        aboard=jnp.where(comes_up, jnp.where(full, 0, state.aboard) - 1, state.aboard),
        surfaced=~under & (state.surfaced | comes_up),
        reload=jnp.maximum(state.reload - 1, 0),
        enemy_wait=jnp.maximum(state.enemy_wait - 1, 0),
        diver_wait=jnp.maximum(state.diver_wait - 1, 0),
        spawn=state.spawn - (harder & (state.spawn > 1)),
        move=state.move - faster,
        ramp=state.ramp + harder,
    )
    return state, points, over
