/* The enumeration of all worlds and `basic` with its map checked, in C: what the kernels are
 * compared with. Written like topo_verify/compiled/ (enumeration.py, chart.py, motion.py,
 * exploration.py, judging/verdict.py), function by function, with the same order of steps.
 *
 *     compiled_twin EDGES MODE START STOP      MODE: 0 enumeration, 1 basic, 2 basic and its map
 *
 * prints the number of worlds, the sum of the costs, the worst cost and the processor seconds.
 * benchmarks/compiled.py builds and runs it; cost and number must be those of the kernels.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define MOST 24
#define SHIFT 16
#define MASK 65535

typedef int64_t num;

/* the world: other end and vertex of a dart; first dart and degree of a vertex */
static num al[MOST], vt[MOST], st[MOST], dg[MOST];
static num m2, vertices;

/* ---------------------------------------------------------------- the robot */
static num pos, cost;

static inline num sensed(num d) {
    num v = vt[d], p = dg[v] << SHIFT;
    if (v == 0) p += 1 + (d > 0 ? dg[0] - d : 0);
    return p;
}

static inline num move(num door) {
    num v = vt[pos], exit_dart = pos + door;
    if (exit_dart >= st[v] + dg[v]) exit_dart -= dg[v];
    pos = al[exit_dart];
    cost++;
    return sensed(pos);
}

/* ---------------------------------------------------------------- S */
static num nv, darts, nu;
static num ca[MOST], cv[MOST], cp[MOST], un[MOST], cf[MOST], cd[MOST], sg[MOST], uo[MOST];
static num dep[MOST], par[MOST], queue[MOST], rem_[MOST];

static num add_vertex(num p) {
    num first = darts, degree = p >> SHIFT, marker = p & MASK;
    cf[nv] = first;
    cd[nv] = degree;
    uo[nv] = degree;
    sg[nv] = 2 * degree + (marker > 0);
    for (num k = 0; k < degree; k++) {
        num d = first + k, at = marker - 1 - k;
        ca[d] = -1;
        cv[d] = nv;
        un[d] = 1;
        cp[d] = (degree << SHIFT) + (marker ? 1 + (at < 0 ? at + degree : at) : 0);
    }
    nv++;
    darts += degree;
    nu += degree;
    return first;
}

static inline void leave_u(num d) {
    if (un[d]) {
        un[d] = 0;
        nu--;
        uo[cv[d]]--;
    }
}

static inline void join(num e, num o) {
    ca[e] = o;
    ca[o] = e;
    leave_u(e);
    leave_u(o);
}

static inline num door(num a, num x) {
    num k = x - a;
    return k < 0 ? k + cd[cv[a]] : k;
}

static void tree(num root, num until) {
    for (num v = 0; v < nv; v++) dep[v] = -1;
    num head = 0, tail = 1;
    queue[0] = root;
    dep[root] = 0;
    par[root] = -1;
    while (head < tail) {
        num v = queue[head++];
        if (v == until) return;
        for (num d = cf[v]; d < cf[v] + cd[v]; d++) {
            if (ca[d] < 0) continue;
            num u = cv[ca[d]];
            if (dep[u] < 0) {
                dep[u] = dep[v] + 1;
                par[u] = ca[d];
                queue[tail++] = u;
            }
        }
    }
}

static num nearest(num at) {
    num root = cv[at], head = 0, tail = 1, best = -1, reach = 0;
    for (num v = 0; v < nv; v++) dep[v] = -1;
    queue[0] = root;
    dep[root] = 0;
    while (head < tail) {
        num v = queue[head++];
        if (best >= 0 && dep[v] > reach) break;
        if (uo[v] > 0) {
            num d = cf[v];
            while (!un[d]) d++;
            if (best < 0 || d < best) {
                best = d;
                reach = dep[v];
            }
        } else if (best < 0) {
            for (num d = cf[v]; d < cf[v] + cd[v]; d++) {
                if (ca[d] < 0) continue;
                num u = cv[ca[d]];
                if (dep[u] < 0) {
                    dep[u] = dep[v] + 1;
                    queue[tail++] = u;
                }
            }
        }
    }
    return best;
}

/* ---------------------------------------------------------------- excursions, basic: retrace */
static num turned, ndoors, doors[MOST], pp[MOST + 1];

static void back(void) {
    while (ndoors > 0) {
        num k = -turned;
        if (k < 0) k += dg[vt[pos]];
        move(k);
        turned = doors[--ndoors];
    }
}

static num execute(num h) { /* the first step whose percept differs; -1: none */
    back();
    num at = h;
    for (num step = 0;; step++) {
        if (pp[step] != cp[at]) return step;
        num up = par[cv[at]];
        if (up < 0) return -1;
        num k = door(at, up), go = k - turned;
        if (go < 0) go += dg[vt[pos]];
        pp[step + 1] = move(go);
        doors[ndoors++] = k;
        turned = 0;
        at = ca[up];
    }
}

static num hypotheses(num p) {
    num signature = 2 * (p >> SHIFT) + ((p & MASK) > 0), n = 0;
    for (num v = 0; v < nv; v++)
        if (sg[v] == signature && uo[v] > 0)
            for (num d = cf[v]; d < cf[v] + cd[v]; d++)
                if (un[d]) rem_[n++] = d;
    if (n > 0) {
        tree(0, -1);
        for (num i = 1; i < n; i++) {
            num h = rem_[i], k = dep[cv[h]], j = i - 1;
            for (; j >= 0 && dep[cv[rem_[j]]] > k; j--) rem_[j + 1] = rem_[j];
            rem_[j + 1] = h;
        }
    }
    return n;
}

static void explore(void) {
    pos = cost = nv = darts = nu = turned = ndoors = 0;
    add_vertex(sensed(0));
    num at = 0;
    while (nu > 0) {
        num e = nearest(at);
        leave_u(e);
        if (cv[at] != cv[e]) {
            tree(cv[e], cv[at]); /* par leads towards e */
            while (cv[at] != cv[e]) {
                num up = par[cv[at]];
                move(door(at, up));
                at = ca[up];
            }
        }
        num p = move(door(at, e)), found = -1;
        turned = ndoors = 0;
        pp[0] = p;
        num n = hypotheses(p);
        for (num i = 0; i < n && found < 0; i++)
            if (execute(rem_[i]) < 0) found = rem_[i];
        if (found < 0) {
            back();
            found = add_vertex(p);
        }
        join(e, found);
        num marker = sensed(pos) & MASK;
        if (marker > 0)
            at = marker == 1 ? 0 : cd[0] - marker + 1;
        else {
            back();
            at = found + turned;
            if (at >= cf[cv[found]] + cd[cv[found]]) at -= cd[cv[found]];
        }
    }
}

static int is_world(void) { /* the image of a dart decides that of its vertex and other end */
    static num image[MOST];
    if (darts != m2 || nv != vertices || cd[0] != dg[0]) return 0;
    for (num d = 0; d < m2; d++) image[d] = -1;
    for (num d = 0; d < dg[0]; d++) image[d] = d;
    for (num d = 0; d < m2; d++) {
        num o = ca[d], im = al[image[d]];
        if (o < 0 || o >= m2 || ca[o] != d || o == d) return 0;
        if (image[o] < 0) {
            num v = cv[o], w = vt[im];
            if (cd[v] != dg[w]) return 0;
            for (num k = 0; k < cd[v]; k++) {
                num x = o + k, y = im + k;
                if (x >= cf[v] + cd[v]) x -= cd[v];
                if (y >= st[w] + dg[w]) y -= dg[w];
                image[x] = y;
            }
        } else if (image[o] != im)
            return 0;
    }
    return 1;
}

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
    if (argc != 5) return 2;
    m2 = 2 * atoll(argv[1]);
    num mode = atoll(argv[2]), start = atoll(argv[3]), stop = atoll(argv[4]), total = 0, most = 0;
    if (m2 < 2 || m2 > MOST) return 2;
    completions();
    skip = start;
    clock_t begin = clock();
    for (num rank = start; rank < stop; rank++) {
        next_world();
        if (mode == 0) {
            total += vertices;
            continue;
        }
        explore();
        if (mode == 2 && !is_world()) return 1;
        total += cost;
        if (cost > most) most = cost;
    }
    printf("%lld %lld %lld %.4f\n", (long long)(stop - start), (long long)total, (long long)most,
           (double)(clock() - begin) / CLOCKS_PER_SEC);
    return 0;
}
