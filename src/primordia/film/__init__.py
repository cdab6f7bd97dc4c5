"""A film of a world: births and deaths in all of its cells, and the life of one organism beside them."""
