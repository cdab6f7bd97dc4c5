"""Games without sticky buttons, of which no course is emulated twice.

Such a game depends only on the number of no-ops at its start and on the buttons pressed since. So the
games that were played form trees: each node is a position of the game, and each edge is a button. A life
that presses the same buttons as an earlier life passes through known nodes, which are read. The life is
emulated from its first other button on. A copy follows its parent to the end if it begins with as many
no-ops, and a mutant follows it until the two act differently.
"""

from typing import TYPE_CHECKING, Any

import numpy as np

from primordia.habitats.atari.simulator import FIELDS, Arcade

if TYPE_CHECKING:
    from ale_py import ALEInterface, ALEState

POSITIONS = 2**18
"""largest number of nodes of a process; they take up to 100 MB"""
EVERY = 64
"""nodes from one kept state of the emulator to the next; a state has 8 kB, and takes 16 us to clone"""
START = 0
"""the node at the start of the game, without no-ops; no edge leads to it"""
SEEN = ("ram", "points", "lives", "game_over")
"""fields of a node"""


class Tree:
    """The positions that were reached from some starts, in the order in which they were first reached."""

    def __init__(self, positions: int, buttons: int) -> None:
        self.size = 0
        self.after = np.zeros((positions, buttons), np.int32)
        """the node after each button, 0 if it is not known"""
        self.before = np.zeros(positions, np.int32)
        self.button = np.zeros(positions, np.uint8)
        """the number of the button that led from the node before"""
        self.depth = np.zeros(positions, np.int32)
        self.rows = {
            name: np.zeros((positions, *shape), dtype)
            for name, (dtype, shape) in FIELDS.items()
            if name in SEEN
        }
        self.states: dict[int, ALEState] = {}
        """states of the emulator at some nodes, at every root among them"""

    def add(self, ale: "ALEInterface", points: int) -> int:
        """Add the emulator's position, without an edge to it, and return its node."""
        node, rows = self.size, self.rows
        self.size += 1
        ale.getRAM(rows["ram"][node])
        rows["points"][node], rows["lives"][node] = points, ale.lives()
        rows["game_over"][node] = ale.game_over(with_truncation=False)
        return node

    def join(self, before: int, button: int, node: int) -> None:
        """Add the edge to a node."""
        self.after[before, button] = node
        self.before[node], self.button[node] = before, button
        self.depth[node] = self.depth[before] + 1

    def replanted(self, states: "dict[int, ALEState]") -> "Tree":
        """Return a tree with some of these nodes as its roots, in this order."""
        tree = Tree(*self.after.shape)
        tree.size, tree.states = len(states), dict(enumerate(states.values()))
        for name, rows in self.rows.items():
            tree.rows[name][: tree.size] = rows[list(states)]
        return tree

    def way(self, node: int) -> tuple[int, list[int]]:
        """Return the last node with a kept state on the way to a node, and the buttons from it on."""
        buttons: list[int] = []
        while node not in self.states:
            buttons.append(int(self.button[node]))
            node = int(self.before[node])
        return node, buttons[::-1]


class TreeArcade(Arcade):
    """The emulators of some cells, in one process, without sticky buttons and without a screen.

    The emulator of a cell stays behind while the cell passes through known nodes.
    """

    def __init__(self, arrays: dict[str, np.ndarray], **settings: Any) -> None:
        super().__init__(arrays, **settings)
        cells = len(arrays["action"])
        self._tree = Tree(max(POSITIONS, 16 * cells), len(self._buttons))
        self._node = np.zeros(cells, np.int32)
        """the node of each cell"""
        self._roots = {0: START}
        """the node after each number of no-ops that is known"""
        self._place: dict[int, int] = {}
        """the node of each cell's emulator, -1 if it is at none"""

    def make(self, cell: int) -> None:
        """Make an emulator for another cell."""
        super().make(cell)
        self._place[cell] = START if self._tree.size else self._planted(cell)

    def _planted(self, cell: int) -> int:
        """Add the position of a cell's emulator as a root, and return its node."""
        ale, _ = self._consoles[cell]
        node = self._tree.add(ale, 0)
        self._tree.states[node] = ale.cloneState()
        return node

    def step(self, cells: list[int]) -> None:
        """Let one tick pass; only courses that are not known yet are emulated."""
        self._make_room(len(cells))
        nodes, buttons = self._node[cells], self._arrays["action"].take(cells)
        after = self._tree.after[nodes, buttons]
        for place in np.flatnonzero(after == 0).tolist():
            node, button = int(nodes[place]), int(buttons[place])
            # A cell before this one may have emulated the same tick.
            after[place] = self._tree.after[node, button] or self._emulate(cells[place], button)
        self._node[cells] = after
        for name, known in self._tree.rows.items():
            self._arrays[name][cells] = known.take(after, 0)

    def _emulate(self, cell: int, button: int) -> int:
        """Emulate a tick of a cell and return the new node."""
        ale, tree = self._brought(cell), self._tree
        node = tree.add(ale, self._frames(ale, cell, int(self._buttons[button])))
        tree.join(int(self._node[cell]), button, node)
        if tree.depth[node] % EVERY == 0:
            tree.states[node] = ale.cloneState()
        self._place[cell] = node
        return node

    def _brought(self, cell: int) -> "ALEInterface":
        """Return the emulator of a cell, at the cell's node.

        Raises:
            RuntimeError: the emulator did not repeat its own game.
        """
        (ale, _), tree, node = self._consoles[cell], self._tree, int(self._node[cell])
        if self._place[cell] != node:
            known, buttons = tree.way(node)
            ale.restoreState(tree.states[known])
            for button in buttons:
                self._frames(ale, cell, int(self._buttons[button]))
            if (ale.getRAM() != tree.rows["ram"][node]).any():
                raise RuntimeError("the emulator did not repeat a game exactly")
            self._place[cell] = node
        return ale

    def _make_room(self, nodes: int) -> None:
        """Begin another tree if this one has no room for more nodes.

        Its roots are the start and the cells' present positions. Starts after no-ops are forgotten, since
        there may be thousands.
        """
        if self._tree.size + nodes <= len(self._tree.before):
            return
        old, cells = self._tree, {int(self._node[cell]): cell for cell in self._consoles}
        states = {START: old.states[START]}
        for node, cell in cells.items():
            if node not in states:
                states[node] = self._brought(cell).cloneState()
        self._roots = {0: START}
        self._tree, roots = old.replanted(states), {node: root for root, node in enumerate(states)}
        for cell in self._consoles:
            self._node[cell] = roots[int(self._node[cell])]
            self._place[cell] = roots.get(self._place[cell], -1)

    def _begin(self, cell: int, noops: int) -> None:
        self._make_room(1)
        if noops not in self._roots:
            super()._begin(cell, noops)
            self._roots[noops] = self._place[cell] = self._planted(cell)
        self._node[cell] = self._roots[noops]
        for name, known in self._tree.rows.items():
            self._arrays[name][cell] = known[self._node[cell]]

    def save(self, cell: int) -> bytes:
        """Return the dice, the button held, and the emulator's serialised state."""
        self._brought(cell)
        return super().save(cell)

    def load(self, cell: int, state: bytes) -> None:
        """Restore a state that `save` returned."""
        self._make_room(1)
        super().load(cell, state)
        self._node[cell] = self._place[cell] = self._planted(cell)
