"""Several runs side by side, from their records alone. The units are worlds."""
