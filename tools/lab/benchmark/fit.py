"""Laws through measured points, by least squares."""

import math


def straight_line(xs, ys):
    """Slope and height at 0 of the line with the least squared differences in y. None if all x are the same."""
    count = len(xs)
    mean_x, mean_y = sum(xs) / count, sum(ys) / count
    spread = sum((x - mean_x) ** 2 for x in xs)
    if spread == 0.0:
        return None
    slope = sum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys)) / spread
    return slope, mean_y - slope * mean_x


def power_law(xs, ys):
    """Exponent k and factor c of y = c x^k with the least squared differences in log y. None where a logarithm does not
    exist or all x are the same."""
    if len(xs) < 2 or min(*xs, *ys) <= 0.0:
        return None
    line = straight_line([math.log(x) for x in xs], [math.log(y) for y in ys])
    return line and (line[0], math.exp(line[1]))


def last_exponent(points, count=3):
    """Exponent of the power law through the `count` points with the largest x: there the constant part weighs least. None
    if there are fewer, or if no power law goes through them. A y of None is a point that was not measured."""
    known = sorted((x, y) for x, y in points if y is not None)[-count:]
    if len(known) < count:
        return None
    law = power_law(*zip(*known))
    return law and law[0]
