#!/usr/bin/env python3
"""A reference for a Wean Hall log, of which nobody recorded where the robot was.

  tests/bench/smooth.py LOG.log.gz WEAN.dat.gz TRACK.csv OUT.csv [first second]

Holds the ends of a track of `docent replay --track` fast and finds all poses between them at once, from the whole log's
odometry and scans: Gauss-Newton over odometry (3 % a metre, robust, its scale learned) and the scans' distances to the map's walls (robust,
a scan counts like 15 beams). What comes after a scan helps as much as what came before it, which no filter has.
Needs python3-numpy.
"""
import gzip, sys
import numpy as np

RESOLUTION = 0.1  # m, of wean.dat
WALL_BELOW = 0.35  # probability of being free
FAR = 2.0  # m, of the distance field
LASER_AHEAD = 0.25  # m
LONGEST = 30.0  # m, of a beam
BEAMS = 15.0  # independent ones that a scan counts for


def wrap(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


def relative(a, b):
    """Poses b seen from poses a."""
    c, s = np.cos(a[:, 2]), np.sin(a[:, 2])
    dx, dy = b[:, 0] - a[:, 0], b[:, 1] - a[:, 1]
    return np.stack([c * dx + s * dy, -s * dx + c * dy, wrap(b[:, 2] - a[:, 2])], -1)


def read_map(path):
    """Distance to the nearest wall in m, indexed [x, y], at most FAR."""
    with gzip.open(path, "rt") as lines:
        for line in lines:
            if line.startswith("global_map[0]"):
                break
        free = np.array([[float(word) for word in line.split()] for line in lines if line.strip()])
    reach = round(FAR / RESOLUTION)
    walls = np.pad((free >= 0) & (free < WALL_BELOW), reach)
    distance = np.full(free.shape, FAR)
    for i in range(-reach, reach + 1):
        for j in range(-reach, reach + 1):
            shifted = walls[reach + i:reach + i + free.shape[0], reach + j:reach + j + free.shape[1]]
            np.minimum(distance, np.where(shifted, RESOLUTION * np.hypot(i, j), FAR), out=distance)
    return distance


def read_log(path):
    """Times, odometry poses and ranges in m of the records with a scan."""
    with gzip.open(path, "rt") as lines:
        scans = np.array([[float(word) for word in line.split()[1:]] for line in lines if line.startswith("L ")])
    return scans[:, -1], scans[:, :3] * [0.01, 0.01, 1.0], 0.01 * scans[:, 6:186]


def bilinear(grid, x, y):
    u = np.clip(x / RESOLUTION - 0.5, 0, grid.shape[0] - 1.01)
    v = np.clip(y / RESOLUTION - 0.5, 0, grid.shape[1] - 1.01)
    i, j = u.astype(int), v.astype(int)
    u, v = u - i, v - j
    return (grid[i, j] * (1 - u) + grid[i + 1, j] * u) * (1 - v) + (grid[i, j + 1] * (1 - u) + grid[i + 1, j + 1] * u) * v


class Scans:
    """What the scans say about each pose: normal equations of robust distances to the walls."""

    def __init__(self, distance, ranges, moved):
        angles = np.deg2rad(-90.0 + np.arange(ranges.shape[1]))[::2]
        ranges = ranges[:, ::2]
        self.x, self.y = LASER_AHEAD + ranges * np.cos(angles), ranges * np.sin(angles)
        self.met = ranges < LONGEST
        self.distance = distance
        self.slope = np.gradient(distance, RESOLUTION)
        # A scan at rest repeats the one before.
        fresh = np.clip(np.concatenate([[1.0], np.hypot(moved[:, 0], moved[:, 1]) / 0.1 + np.abs(moved[:, 2]) / 0.05]), 0.05, 1.0)
        self.weight = fresh * BEAMS / np.maximum(self.met.sum(1), 1)

    def normal(self, poses, sigma):
        c, s = np.cos(poses[:, 2])[:, None], np.sin(poses[:, 2])[:, None]
        x, y = c * self.x - s * self.y, s * self.x + c * self.y
        at = x + poses[:, :1], y + poses[:, 1:2]
        off = bilinear(self.distance, *at)
        dx, dy = bilinear(self.slope[0], *at), bilinear(self.slope[1], *at)
        weight = self.met * np.exp(-0.5 * (off / sigma) ** 2) / sigma ** 2 * self.weight[:, None]
        jacobian = np.stack([dx, dy, dy * x - dx * y], -1)
        return np.einsum("nb,nbi,nbj->nij", weight, jacobian, jacobian), np.einsum("nb,nbi,nb->ni", weight, jacobian, off)


def odometry_normal(poses, moved, precision):
    """Normal equations of the odometry: blocks on the diagonal, beside it, and the gradient."""
    a, b = poses[:-1], poses[1:]
    error = relative(a, b) - moved
    error[:, 2] = wrap(error[:, 2])
    squared = np.sum((error * precision) ** 2, 1)
    precision = precision / np.sqrt(1.0 + squared / 9.0)[:, None]
    c, s = np.cos(a[:, 2]), np.sin(a[:, 2])
    seen = relative(a, b)
    zero, one = np.zeros_like(c), np.ones_like(c)
    of_b = np.stack([np.stack([c, s, zero], -1), np.stack([-s, c, zero], -1), np.stack([zero, zero, one], -1)], 1)
    of_a = -of_b
    of_a[:, 0, 2], of_a[:, 1, 2] = seen[:, 1], -seen[:, 0]
    of_a, of_b, error = of_a * precision[:, :, None], of_b * precision[:, :, None], error * precision
    diagonal, gradient = np.zeros((len(poses), 3, 3)), np.zeros((len(poses), 3))
    diagonal[:-1] += np.einsum("nki,nkj->nij", of_a, of_a)
    diagonal[1:] += np.einsum("nki,nkj->nij", of_b, of_b)
    gradient[:-1] += np.einsum("nki,nk->ni", of_a, error)
    gradient[1:] += np.einsum("nki,nk->ni", of_b, error)
    return diagonal, np.einsum("nki,nkj->nij", of_a, of_b), gradient


def solve_chain(diagonal, beside, gradient):
    """The step of a chain of poses: block elimination."""
    inverse, right = [np.linalg.inv(diagonal[0])], [gradient[0]]
    for k in range(1, len(diagonal)):
        factor = beside[k - 1].T @ inverse[-1]
        right.append(gradient[k] - factor @ right[-1])
        inverse.append(np.linalg.inv(diagonal[k] - factor @ beside[k - 1]))
    step = [inverse[-1] @ right[-1]]
    for k in range(len(diagonal) - 2, -1, -1):
        step.append(inverse[k] @ (right[k] - beside[k] @ step[-1]))
    return -np.array(step[::-1])


def first_guess(track, moved):
    """The odometry's ways along the track's headings, with the gap at the end spread over the way."""
    poses = track.copy()
    for k in range(1, len(poses)):
        c, s = np.cos(track[k - 1, 2]), np.sin(track[k - 1, 2])
        x, y = moved[k - 1, :2]
        poses[k, :2] = poses[k - 1, :2] + [c * x - s * y, s * x + c * y]
    way = np.concatenate([[0.0], np.cumsum(np.hypot(moved[:, 0], moved[:, 1]))])
    poses[:, :2] += np.outer(way / way[-1], track[-1, :2] - poses[-1, :2])
    return poses


def smooth(log, map_file, track, first=0.0, last=np.inf):
    """Rows of time, x, y, theta."""
    times, odometry, ranges = read_log(log)
    known = np.loadtxt(track, delimiter=",", skiprows=1)
    within = (times >= max(first, known[0, 0])) & (times <= min(last, known[-1, 0]))
    times, odometry, ranges = times[within], odometry[within], ranges[within]
    moved = relative(odometry[:-1], odometry[1:])
    way, turned = np.hypot(moved[:, 0], moved[:, 1]), np.abs(moved[:, 2])
    metres = 0.003 + 0.03 * way + 0.01 * turned
    precision = 1.0 / np.stack([metres, metres, 0.004 + 0.08 * turned + 0.01 * way], -1)
    scans = Scans(read_map(map_file), ranges, moved)
    nearest = [int(np.argmin(np.abs(known[:, 0] - time))) for time in times]
    poses = first_guess(known[nearest, 1:], moved)
    for sigma in [0.3] * 8 + [0.2] * 8 + [0.15] * 8:
        diagonal, beside, gradient = odometry_normal(poses, moved, precision)
        of_scans, pull = scans.normal(poses, sigma)
        diagonal += of_scans + 1e-6 * np.eye(3)
        diagonal[[0, -1]] += 1e6 * np.eye(3)
        poses += np.clip(solve_chain(diagonal, beside, gradient + pull), -0.5, 0.5)
        poses[:, 2] = wrap(poses[:, 2])
        # The wheels' size is learned on the way.
        ahead = relative(poses[:-1], poses[1:])[:, 0]
        moved[:, :2] *= np.sum(ahead * moved[:, 0]) / np.sum(moved[:, 0] ** 2)
    return np.column_stack([times, poses])


if __name__ == "__main__":
    if len(sys.argv) not in (5, 7):
        sys.exit(__doc__)
    rows = smooth(*sys.argv[1:4], *map(float, sys.argv[5:]))
    np.savetxt(sys.argv[4], rows, fmt="%.6f", delimiter=",", header="time,x,y,theta", comments="")
