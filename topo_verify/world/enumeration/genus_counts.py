"""Counts rooted maps by edges and genus.

The letters: `m` edges, `g` genus, `Q[g][m]` the number of rooted maps with both. For m >= 1,

    (m+1)/6 · Q[g][m] = (4m-2)/3 · Q[g][m-1] + (2m-3)(2m-2)(2m-1)/12 · Q[g-1][m-2]
                        + 1/2 · Σ (2k-1)(2l-1) · Q[i][k-1] · Q[j][l-1],

the sum over k + l = m with k, l >= 1 and i + j = g; Q[0][0] = 1, and Q is 0 outside. It knows
nothing of how maps are listed here, so its agreement with the lists (tests) is evidence for both.

Source: S. R. Carrell and G. Chapuy, "Simple recurrence formulas to count maps on orientable
surfaces", J. Combin. Theory Ser. A 133 (2015), theorem 1.
"""

from __future__ import annotations

from topo_verify.errors import InputError


def count_genus(edges: int, genus: int) -> int:
    """The number of rooted maps with this many edges and exactly this genus.

    Complexity: O(edges² · genus²) products.
    Raises:
        InputError: a negative number.
    """
    if edges < 0 or genus < 0:
        raise InputError(f"expected 0 or more edges and genus, got edges={edges}, genus={genus}")
    # Euler: n + f = m + 2 - 2g, and every map has a vertex and a face.
    if 2 * genus > edges:
        return 0
    known: list[list[int]] = []  # known[g][m], the Q of the module's docstring
    for g in range(genus + 1):
        known.append([int(g == 0)])
        for m in range(1, edges + 1):
            known[g].append(_next(known, g, m))
    return known[genus][edges]


def _next(known: list[list[int]], g: int, m: int) -> int:
    """Q[g][m] from what is known for lower g, or for the same g and lower m."""
    # The recurrence times 6, so that every term is an integer; the division leaves no remainder.
    total = 4 * (2 * m - 1) * known[g][m - 1]
    if g and m >= 2:
        total += (2 * m - 3) * (m - 1) * (2 * m - 1) * known[g - 1][m - 2]
    for k in range(1, m):
        products = sum(known[i][k - 1] * known[g - i][m - k - 1] for i in range(g + 1))
        total += 3 * (2 * k - 1) * (2 * (m - k) - 1) * products
    return total // (m + 1)
