#!/usr/bin/env python3
"""A reference for the Wean Hall logs, of which nobody recorded where the robot was.

  tests/bench/register.py WEAN_FOLDER OUT_FOLDER

Registers all scans of the three logs with each other at once: Gauss-Newton over the poses of key frames, every 0.3 m of way or 20 degrees,
with the odometry (3 % a metre, robust, its scale learned), the scans' distances to the lines that other scans from nearby saw, whichever log
they are of (point to line, robust, 20 independent beams a scan), and weakly, 3 beams a scan, their distances to the walls of wean.dat, which puts
the result into that map's frame. First each log alone, from odometry and neighbouring scans; then all together, with a net that tightens.
Writes OUT_FOLDER/robotdata1.csv to 3: time, x, y, theta of the key frames. Takes some minutes. Needs python3-numpy.
"""
import gzip, pathlib, sys
import numpy as np

RESOLUTION = 0.1  # m, of wean.dat
WALL_BELOW = 0.35  # probability of being free
FAR = 2.0  # m, of the distance field
LASER_AHEAD = 0.25  # m
LONGEST = 25.0  # m, of a beam
# All logs begin in the same doorway. Which one shows in what lies where they drive to: the corridor's end, the room behind it.
START = np.array([40.0, 41.6, np.deg2rad(-95.0)])
ANGLES = np.deg2rad(-90.0 + np.arange(180))


def wrap(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


def compose(a, b):
    """Poses b, given in the frames of poses a."""
    c, s = np.cos(a[..., 2]), np.sin(a[..., 2])
    return np.stack([a[..., 0] + c * b[..., 0] - s * b[..., 1], a[..., 1] + s * b[..., 0] + c * b[..., 1], wrap(a[..., 2] + b[..., 2])], -1)


def relative(a, b):
    """Poses b seen from poses a."""
    c, s = np.cos(a[..., 2]), np.sin(a[..., 2])
    dx, dy = b[..., 0] - a[..., 0], b[..., 1] - a[..., 1]
    return np.stack([c * dx + s * dy, -s * dx + c * dy, wrap(b[..., 2] - a[..., 2])], -1)


def rotated(points, theta):
    c, s = np.cos(theta), np.sin(theta)
    return points @ np.array([[c, s], [-s, c]])


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


class Frame:
    """A scan in the base's frame: what it met, and where that is a line, the line's normals, towards the laser."""

    def __init__(self, ranges):
        met = (ranges > 0.1) & (ranges < LONGEST)
        all_points = np.stack([LASER_AHEAD + ranges * np.cos(ANGLES), ranges * np.sin(ANGLES)], -1)
        self.points = all_points[met]
        on_line, normals = [], []
        for i in np.nonzero(met)[0]:
            around = np.arange(max(0, i - 3), min(len(ranges), i + 4))
            apart = np.linalg.norm(all_points[around] - all_points[i], axis=1)
            around = all_points[around[met[around] & (apart < max(0.25, 0.12 * ranges[i]))]]
            if len(around) < 4:
                continue
            off = around - around.mean(0)
            spread, axes = np.linalg.eigh(off.T @ off)
            if spread[0] < 0.05 * spread[1]:
                on_line.append(all_points[i])
                towards = np.array([LASER_AHEAD, 0.0]) - all_points[i]
                normals.append(axes[:, 0] * np.sign(axes[:, 0] @ towards))
        self.on_line, self.normals = np.array(on_line).reshape(-1, 2), np.array(normals).reshape(-1, 2)


class Log:
    """Key frames of one log."""

    def __init__(self, path):
        time, odometry, ranges = read_log(path)
        moved = relative(odometry[:-1], odometry[1:])
        way = np.concatenate([[0.0], np.cumsum(np.hypot(moved[:, 0], moved[:, 1]))])
        turned = np.concatenate([[0.0], np.cumsum(np.abs(moved[:, 2]))])
        step = np.floor(way / 0.3) + np.floor(turned / 0.35)
        key = np.unique(np.concatenate([[0], np.nonzero(np.diff(step))[0] + 1, [len(time) - 1]]))
        self.time, self.odometry = time[key], odometry[key]
        self.frames = [Frame(ranges[i]) for i in key]
        self.way, self.turned = np.diff(way[key]), np.diff(turned[key])
        self.poses = compose(START, relative(self.odometry[0], self.odometry))


class Normal:
    """Normal equations over all poses."""

    def __init__(self, count):
        self.matrix, self.gradient = np.zeros((count, count, 3, 3)), np.zeros((count, 3))

    def add(self, i, j, of_i, of_j, error):
        """Rows of a residual of poses i and j, already weighed."""
        self.matrix[i, i] += of_i.T @ of_i
        self.matrix[j, j] += of_j.T @ of_j
        self.matrix[i, j] += of_i.T @ of_j
        self.matrix[j, i] += of_j.T @ of_i
        self.gradient[i] += of_i.T @ error
        self.gradient[j] += of_j.T @ error

    def step(self):
        count = len(self.gradient)
        matrix = self.matrix.transpose(0, 2, 1, 3).reshape(3 * count, 3 * count) + 1e-6 * np.eye(3 * count)
        return -np.linalg.solve(matrix, self.gradient.ravel()).reshape(count, 3)


def robust(error, sigma):
    """Square roots of the weights of residuals in m."""
    return np.exp(-0.25 * (error / sigma) ** 2) / sigma


def add_odometry(normal, poses, moved, precision):
    for k in range(len(moved)):
        error = relative(poses[k], poses[k + 1]) - moved[k]
        error[2] = wrap(error[2])
        sure = precision[k] / np.sqrt(1.0 + np.sum((error * precision[k]) ** 2) / 9.0)
        c, s = np.cos(poses[k, 2]), np.sin(poses[k, 2])
        seen = relative(poses[k], poses[k + 1])
        of_next = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        of_this = -of_next
        of_this[0, 2], of_this[1, 2] = seen[1], -seen[0]
        normal.add(k, k + 1, sure[:, None] * of_this, sure[:, None] * of_next, sure * error)


def slopes(direction, arms):
    """How a residual along `direction` grows with the pose that carries the arms."""
    return np.column_stack([direction, direction[:, 1] * arms[:, 0] - direction[:, 0] * arms[:, 1]])


def add_walls(normal, poses, frames, distance, sigma, beams):
    slope = np.gradient(distance, RESOLUTION)
    for k, frame in enumerate(frames):
        if len(frame.points) == 0:
            continue
        arms = rotated(frame.points, poses[k, 2])
        at = (arms + poses[k, :2]).T
        error = bilinear(distance, *at)
        weight = robust(error, sigma) * np.sqrt(beams / len(arms))
        rows = weight[:, None] * slopes(np.stack([bilinear(slope[0], *at), bilinear(slope[1], *at)], -1), arms)
        normal.matrix[k, k] += rows.T @ rows
        normal.gradient[k] += rows.T @ (weight * error)


def add_pair(normal, poses, frames, i, j, net, beams):
    """The lines of frame i against those of frame j that were seen from the same side."""
    points, lines = frames[i].on_line[::2], frames[j].on_line
    if len(points) < 15 or len(lines) < 15:
        return
    arms = rotated(points, poses[i, 2])
    ends, met = arms + poses[i, :2], rotated(lines, poses[j, 2]) + poses[j, :2]
    centre = poses[i, :2]
    a, b = ends - centre, met - centre
    squared = np.sum(a ** 2, 1)[:, None] - 2.0 * a @ b.T + np.sum(b ** 2, 1)
    nearest = squared.argmin(1)
    across = rotated(frames[j].normals[nearest], poses[j, 2])
    same = np.sum(across * rotated(frames[i].normals[::2], poses[i, 2]), 1) > 0.7
    near = same & (squared[np.arange(len(ends)), nearest] < (1.5 * net) ** 2)
    if near.sum() < 10:
        return
    nearest, ends, across = nearest[near], ends[near], across[near]
    error = np.sum((ends - met[nearest]) * across, 1)
    weight = robust(error, net / 3) * np.sqrt(beams / len(points))
    of_i = weight[:, None] * slopes(across, arms[near])
    of_j = -weight[:, None] * slopes(across, ends - poses[j, :2])
    normal.add(i, j, of_i, of_j, weight * error)


def neighbours(log, count):
    """Pairs of key frames of one log that follow each other closely."""
    return [(i, j) for i in range(len(log)) for j in range(max(0, i - count), min(len(log), i + count + 1))
            if i != j and log[i] == log[j]]


def some_near(poses, log, random, metres=6.0):
    """For each key frame three neighbours and eleven others from nearby."""
    pairs = []
    index = np.arange(len(poses))
    for i in range(len(poses)):
        near = np.hypot(*(poses[:, :2] - poses[i, :2]).T) < metres
        beside = (log == log[i]) & (np.abs(index - i) <= 6)
        pairs += [(i, j) for j in random.permutation(index[near & beside & (index != i)])[:3]]
        pairs += [(i, j) for j in random.permutation(index[near & ~beside])[:11]]
    return pairs


def register(logs, distance):
    """Poses of the key frames, a list a log."""
    random = np.random.default_rng(1)
    frames = [frame for log in logs for frame in log.frames]
    which = np.repeat(np.arange(len(logs)), [len(log.frames) for log in logs])
    first = np.concatenate([[0], np.cumsum([len(log.frames) for log in logs])])
    poses = np.concatenate([log.poses for log in logs])
    scale = 1.0
    for net, together in [(0.5, False)] * 16 + [(1.0, True)] * 8 + [(0.5, True)] * 8 + [(0.3, True)] * 30:
        normal = Normal(len(poses))
        ahead = []
        for log, begin, end in zip(logs, first[:-1], first[1:]):
            part = Normal(0)
            part.matrix, part.gradient = normal.matrix[begin:end, begin:end], normal.gradient[begin:end]
            moved = relative(log.odometry[:-1], log.odometry[1:]) * [scale, scale, 1.0]
            metres = 0.005 + 0.03 * log.way + 0.01 * log.turned
            precision = 1.0 / np.stack([metres, metres, 0.004 + 0.08 * log.turned + 0.01 * log.way], -1)
            add_odometry(part, poses[begin:end], moved, precision)
            ahead.append(np.column_stack([relative(poses[begin:end - 1], poses[begin + 1:end])[:, 0], moved[:, 0]]))
        if together:
            ahead = np.concatenate(ahead)
            scale *= np.sum(ahead[:, 0] * ahead[:, 1]) / np.sum(ahead[:, 1] ** 2)
            add_walls(normal, poses, frames, distance, max(net / 3, 0.15), 3.0)
        else:
            normal.matrix[first[:-1], first[:-1]] += 1e6 * np.eye(3)
        pairs = some_near(poses, which, random) if together else neighbours(which, 4)
        for i, j in pairs:
            add_pair(normal, poses, frames, i, j, net, 20.0 * len(poses) / len(pairs))
        step = np.clip(normal.step(), -1.0, 1.0)
        poses += step
        poses[:, 2] = wrap(poses[:, 2])
        print(f"net {net} m, mean step {np.hypot(step[:, 0], step[:, 1]).mean():.4f} m, odometry's scale {scale:.4f}", flush=True)
    return [poses[begin:end] for begin, end in zip(first[:-1], first[1:])]


def main(data, out):
    logs = [Log(data / f"robotdata{number}.log.gz") for number in (1, 2, 3)]
    for number, log, poses in zip((1, 2, 3), logs, register(logs, read_map(data / "wean.dat.gz"))):
        np.savetxt(out / f"robotdata{number}.csv", np.column_stack([log.time, poses]), fmt=["%.3f", "%.3f", "%.3f", "%.4f"], delimiter=",",
                   header="time,x,y,theta", comments="")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
