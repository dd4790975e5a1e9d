"""90 % intervals of means and of their differences, for the experiments."""
import math
import statistics


def quantile(freedom, part=0.95):
    """Point of Student's distribution below which so much of it lies: with 1 and 2 degrees of freedom in closed form,
    else the normal one and terms in 1/freedom (Abramowitz and Stegun, 26.7.5): at 95 % to 0.6 %, at 99.8 % so from six
    degrees on."""
    middle = 2 * part - 1
    if freedom == 1:
        return math.tan(middle * math.pi / 2)
    if freedom == 2:
        return middle * math.sqrt(2 / (1 - middle ** 2))
    z = statistics.NormalDist().inv_cdf(part)
    return (z + (z ** 3 + z) / (4 * freedom) + (5 * z ** 5 + 16 * z ** 3 + 3 * z) / (96 * freedom ** 2)
            + (3 * z ** 7 + 19 * z ** 5 + 17 * z ** 3 - 15 * z) / (384 * freedom ** 3))


def pool(groups):
    """Standard deviation within groups and its degrees of freedom."""
    freedom = sum(len(group) - 1 for group in groups)
    squares = sum((x - statistics.mean(group)) ** 2 for group in groups for x in group)
    return (math.sqrt(squares / freedom) if freedom else math.nan), freedom


def interval(these, those, deviation, freedom, at_once=1):
    """Difference of the means, and half of its 90 % interval; of so many of them if all are to hold at once
    (Bonferroni)."""
    half = math.nan
    if freedom:
        half = quantile(freedom, 1 - 0.05 / at_once) * deviation * math.sqrt(1 / len(these) + 1 / len(those))
    return statistics.mean(these) - statistics.mean(those), half


def interval_by_own(these, those):
    """Difference of the means, and half of its 90 % interval where each has a variance of its own (Welch)."""
    parts = [(statistics.variance(values) / len(values), len(values) - 1) for values in (these, those)]
    square = sum(part for part, _ in parts)
    freedom = square ** 2 / sum(part ** 2 / degrees for part, degrees in parts)
    return statistics.mean(these) - statistics.mean(those), quantile(freedom) * math.sqrt(square)


def interval_of_mean(values):
    """Mean, and half of its 90 % interval."""
    deviation, freedom = statistics.stdev(values), len(values) - 1
    return statistics.mean(values), quantile(freedom) * deviation / math.sqrt(len(values))
