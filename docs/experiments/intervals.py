"""90 % intervals of means and of their differences, for the experiments."""
import math
import statistics


def quantile(freedom):
    """95 % point of Student's distribution: that of 1 and 2 degrees of freedom in closed form, else the normal one and
    terms in 1/freedom (Abramowitz and Stegun, 26.7.5), to 0.4 %."""
    if freedom == 1:
        return math.tan(0.45 * math.pi)
    if freedom == 2:
        return 0.9 * math.sqrt(2 / (1 - 0.9 ** 2))
    z = 1.6448536269514722
    return (z + (z ** 3 + z) / (4 * freedom) + (5 * z ** 5 + 16 * z ** 3 + 3 * z) / (96 * freedom ** 2)
            + (3 * z ** 7 + 19 * z ** 5 + 17 * z ** 3 - 15 * z) / (384 * freedom ** 3))


def pool(groups):
    """Standard deviation within groups and its degrees of freedom."""
    freedom = sum(len(group) - 1 for group in groups)
    squares = sum((x - statistics.mean(group)) ** 2 for group in groups for x in group)
    return (math.sqrt(squares / freedom) if freedom else math.nan), freedom


def interval(these, those, deviation, freedom):
    """Difference of the means, and half of its 90 % interval."""
    half = quantile(freedom) * deviation * math.sqrt(1 / len(these) + 1 / len(those)) if freedom else math.nan
    return statistics.mean(these) - statistics.mean(those), half


def interval_of_mean(values):
    """Mean, and half of its 90 % interval."""
    deviation, freedom = statistics.stdev(values), len(values) - 1
    return statistics.mean(values), quantile(freedom) * deviation / math.sqrt(len(values))
