"""Pairwise choice of test cases: every value of one axis meets every value of every other axis at least once."""

from itertools import combinations


def pairwise(axes):
    """Return rows (dictionaries) that contain every pair of values of two different axes.

    Greedy covering array: each new row starts from a pair that is still missing, and every other axis takes the value
    that adds most missing pairs. The choice is deterministic; earlier values win ties.

    Parameters
    ----------
    axes : name of each axis and the sequence of its values.
    """
    names = list(axes)
    missing = {
        (a, i, b, j): None
        for a, b in combinations(range(len(names)), 2)
        for i in range(len(axes[names[a]]))
        for j in range(len(axes[names[b]]))
    }
    used = {(a, i): 0 for a, name in enumerate(names) for i in range(len(axes[name]))}
    rows = []
    while missing:
        a, i, b, j = next(iter(missing))
        chosen = {a: i, b: j}
        for axis, name in enumerate(names):
            if axis in chosen:
                continue
            best = None
            for value in range(len(axes[name])):
                gain = sum(_key(axis, value, other, at) in missing for other, at in chosen.items())
                rank = (gain, -used[axis, value])
                if best is None or rank > best[0]:
                    best = (rank, value)
            chosen[axis] = best[1]
        for axis, value in chosen.items():
            used[axis, value] += 1
        for one, other in combinations(chosen, 2):
            missing.pop(_key(one, chosen[one], other, chosen[other]), None)
        rows.append({name: axes[name][chosen[axis]] for axis, name in enumerate(names)})
    return rows


def _key(axis, value, other, at):
    return (axis, value, other, at) if axis < other else (other, at, axis, value)
