/* The enumeration of all worlds in C: what the kernel is compared with. Written like
 * topo_verify/extra/fast/kernels/enumeration.py, with the same order of steps.
 *
 *     compiled_twin EDGES STOP
 *
 * prints the processor seconds for the first STOP worlds. benchmarks/compiled.py builds and runs it.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define MOST 24

typedef int64_t num;

/* the world: other end and vertex of a dart; first dart and degree of a vertex */
static num al[MOST], vt[MOST], st[MOST], dg[MOST];
static num m2, vertices;

/* ---------------------------------------------------------------- enumeration */
static num f[2 * MOST + 2][2 * MOST + 2];

static void completions(void) {
    for (num t = 0; t <= m2; t++)
        for (num r = 0; r <= t; r++) {
            num u = t - r, ways = u >= 2 ? (u - 1) * f[u - 2][r] : 0;
            for (num d = 1; d <= r && u; d++)
                if (u + d >= 2) ways += f[u + d - 2][r - d];
            f[u][r] = u ? ways : r == 0;
        }
}

static num at_dart[MOST], at_partner[MOST], is_new[MOST];
static num depth, created, open_, root, skip;

static void next_world(void) {
    num k = depth, n = created, u = open_, v = vertices, e, c;
    for (;;) {
        if (k > 0) {
            k--;
            e = at_dart[k];
            c = at_partner[k];
            al[e] = -1;
            if (is_new[k]) {
                v--;
                n = st[v];
                u -= dg[v] - 2;
                al[n] = -1;
            } else {
                al[c] = -1;
                u += 2;
            }
        } else {
            for (root++; skip >= f[root][m2 - root]; root++) skip -= f[root][m2 - root];
            n = u = dg[0] = root;
            for (num d = 0; d < m2; d++) al[d] = -1;
            for (num d = 0; d < n; d++) vt[d] = 0;
            v = 1;
            e = c = st[0] = 0;
        }
        while (u > 0) {
            for (c++; c < m2; c++)
                if (c < n ? al[c] < 0 && (u > 2 || n == m2) : u > 1 || c > n || n + 1 == m2) break;
            if (c >= m2) break;
            if (skip > 0) {
                num ways = c < n ? f[u - 2][m2 - n] : f[u + c - n - 1][m2 - c - 1];
                if (skip >= ways) {
                    skip -= ways;
                    continue;
                }
            }
            at_dart[k] = e;
            at_partner[k] = c;
            if (c < n) {
                al[e] = c;
                al[c] = e;
                u -= 2;
                is_new[k] = 0;
            } else {
                st[v] = n;
                dg[v] = c + 1 - n;
                for (num d = n; d <= c; d++) vt[d] = v;
                al[e] = n;
                al[n] = e;
                v++;
                u += c - n - 1;
                n = c + 1;
                is_new[k] = 1;
            }
            k++;
            if (u > 0) {
                while (al[e] >= 0) e++;
                c = e;
            }
        }
        if (u == 0) {
            depth = k;
            created = n;
            open_ = u;
            vertices = v;
            return;
        }
    }
}

int main(int argc, char **argv) {
    if (argc != 3) return 2;
    m2 = 2 * atoll(argv[1]);
    num stop = atoll(argv[2]);
    if (m2 < 2 || m2 > MOST) return 2;
    completions();
    clock_t begin = clock();
    for (num rank = 0; rank < stop; rank++) next_world();
    printf("%.4f\n", (double)(clock() - begin) / CLOCKS_PER_SEC);
    return 0;
}
