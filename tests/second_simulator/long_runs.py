"""What `covered_rays` says, for runs of hours: most of the time a solid hardly moves.

A block of ticks is decided at once where it can be. In its middle pose a solid is made larger by the distance that it
moves by in the block; the rays that miss this miss the solid all the time. It is made smaller by as much; the rays that
hit this hit the solid all the time. Other rays are looked at again in shorter blocks, and at last tick by tick. A test
compares every ray at every tick with `covered_rays`.
"""
import numpy as np

from second_simulator import distance_of_line, entry, reach_of

BLOCKS = (256, 32, 4, 1)  # ticks; each a multiple of the next
ROUNDING_M = 1e-9


def covered_in_blocks(rays, motion):
    """As `covered_rays`, all ticks at once."""
    seen = np.zeros((len(motion.times), len(rays.limits)), bool)
    for about, origins, rotations, present in motion.solids:
        if present.any():
            cover(seen, rays, about, origins, rotations, present)
    yield slice(1, len(seen)), seen[1:]


def cover(seen, rays, about, origins, rotations, present):
    """Marks what one solid covers while it is present."""
    limits = rays.limits
    block, ray = None, None  # pairs that aren't decided yet
    for length, shorter in zip(BLOCKS, (*BLOCKS[1:], 0)):
        middle, moves = moves_in_blocks(about, origins, rotations, length)
        if block is None:
            near = distance_of_line(rays, origins[middle]) <= (reach_of(about) + moves + 1e-6)[:, None]
            block, ray = np.nonzero(near)
        at = middle[block]
        touches = lambda which, by: entry(resized(about, by), rays.origins[ray[which]], rays.directions[ray[which]],
                                          origins[at[which]], rotations[at[which]]) < limits[ray[which]]
        may = np.flatnonzero(touches(slice(None), moves[block]))
        if not shorter:
            seen[block[may], ray[may]] |= present[block[may]]
            return
        does = touches(may, -moves[block[may]]) & (least_of(about) > moves[block[may]])
        mark(seen, present, block[may[does]], ray[may[does]], length)
        block, ray = pieces(block[may[~does]], ray[may[~does]], length // shorter, -(-len(seen) // shorter))


def moves_in_blocks(about, origins, rotations, length):
    """Of each block, the tick in its middle, and the farthest that the solid's surface is from there at another tick."""
    n = len(origins)
    middle = np.minimum(np.arange(0, n, length) + length // 2, n - 1)
    if length == 1:
        return middle, np.zeros(n)
    of_tick = middle[np.arange(n) // length]
    moves = np.linalg.norm(origins - origins[of_tick], axis=1)
    if about["primitive"] == "capsule":
        moves += about["half_length_m"] * np.linalg.norm((rotations - rotations[of_tick])[..., :, 1], axis=1)
    elif about["primitive"] == "box":
        moves += reach_of(about) * np.linalg.norm(rotations - rotations[of_tick], axis=(1, 2))
    return middle, np.maximum.reduceat(moves, np.arange(0, n, length)) + ROUNDING_M


def resized(about, by):
    """The solid with each surface farther out by so much, an array of one number a pair."""
    if about["primitive"] == "box":
        return {**about, "half_extents_m": np.maximum(about["half_extents_m"] + by[:, None], 0)}
    return {**about, "radius_m": np.maximum(about["radius_m"] + by, 0)}


def least_of(about):
    return min(about["half_extents_m"]) if about["primitive"] == "box" else about["radius_m"]


def mark(seen, present, block, ray, length):
    ticks = block[:, None] * length + np.arange(length)
    ticks = np.minimum(ticks, len(seen) - 1)  # the last block may be shorter
    seen[ticks, ray[:, None]] |= present[ticks]


def pieces(block, ray, n, n_blocks):
    """The shorter blocks of these, n of each but at the end of the run."""
    block = (block[:, None] * n + np.arange(n)).ravel()
    inside = block < n_blocks
    return block[inside], np.repeat(ray, n)[inside]
