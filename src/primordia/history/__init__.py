"""What happened in one run, from its records alone: numbers, curves over time, genomes.

Nothing lives again here. Who descends from whom is in `phylogeny`, the measurements for which organisms
live again are in `assays`, and several runs side by side are in `comparison`.
"""
