"""The text of `shadow`: the lives of originals and shadows, and their comparison."""

import numpy as np

from primordia.assays.shadow import Shadow
from primordia.cli.shadow import shadow_text


def test_the_text_has_the_lives_of_originals_and_of_shadows() -> None:
    """The 95 % interval is shown only if there are five or more worlds."""
    original = [[1000, 3000], [4000], [500, 500], [100]]
    shadow = [[1000, 1000], [2000], [4000, 100], [100]]
    world = np.repeat(np.arange(4), [2, 1, 2, 1]).astype(np.int32)
    one, other = (np.concatenate(each).astype(np.int64) for each in (original, shadow))
    assert shadow_text(Shadow("run", 4321, world, one, other, cut=3000)).splitlines() == [
        "run: 6 organisms, each born again alone, from 4,321 births in 4 worlds; 12 lives,"
        " 17,300 ticks",
        "                 mean life       reach 3,000 ticks",
        "  organisms        1,516.7               2 (33.3%)",
        "  shadows          1,366.7               1 (16.7%)",
        "  organisms live longer than their shadows in 2 worlds and shorter in 1 (sign test, p = 1)",
        "  in the median world organisms live 1.50 times as long",
    ]
    many = np.arange(6, dtype=np.int32)
    text = shadow_text(Shadow("run", 6, many, np.full(6, 30), np.full(6, 10), cut=40))
    assert text.endswith("organisms live 3.00 times as long, 95 % interval 3.00 to 3.00")
    natives = Shadow("run", 6, many, np.full(6, 30), np.full(6, 10), 40, "lagoon")
    assert shadow_text(natives).startswith("run: 6 organisms born on lagoon, each born again alone")
    assert natives.to_dict()["island"] == "lagoon"
    alone = shadow_text(Shadow("run", 6, np.zeros(1, np.int32), np.ones(1), np.ones(1), cut=40))
    assert "from 6 births in 1 world;" in alone
    assert "longer than their shadows in 6 worlds and shorter in 0 (sign test, p = 0.031)" in text
