(** The eight algorithms of the paper, each correct and within the bound (claims 5, 6 and 7; listings
    1, 2 and 3).

    algorithm                     rule               motion
    basic                         none               retrace        listing 1
    enhancement_i                 prefix             overlap        listing 2
    enhancement_ii, _ii_i         history            retrace, overlap
    enhancement_iii_one, _one_i   records, 1 level   retrace, overlap
    enhancement_iii_all, _all_i   records            retrace, overlap    listing 3

    SCEPTICS READ [algorithm], [maps_all] and the definitions of Mapper.v, Rules.v and Ways.v. *)
From Coq Require Import Arith Lia List.
Import ListNotations.
From Topo Require Import World Vertices Augment Program Mapper MapperCorrect Rules Ways
  ReferencePolicies.

(** An algorithm: a rule and a motion. The policies are chosen apart. *)
Definition algorithm : Type := Rule * Motion.

(** With this algorithm and these policies, a mapper that may explore so many edges. *)
Definition run_of (A : algorithm) pick path order fuel :=
  mapper pick path order (snd A) (fst A) fuel.

(** In every world and with all policies the algorithm ends with a map that is isomorphic to the
    world. It makes at least m moves and at most m (n + (2m - 1) 2(n - 1)), where the world has m
    edges and n vertices. *)
Definition maps_all (A : algorithm) := forall pick path order W, good_pick pick -> good_path path ->
  good_order order -> world W -> exists M b ms m,
  perform W (root W) (run_of A pick path order (darts W) (percept W (root W))) = Some (M, b, ms) /\
  isomorphic M W /\ darts W = 2 * m /\
  m <= length ms <= m * (vertices W + (2 * m - 1) * (2 * (vertices W - 1))).

(** Claims 5 and 7 for every algorithm whose rule and motion fulfil their contracts.
    Paper, I: The worst case is O(m²n) edge traversals. *)
Theorem cost_within_bound A true_of : good_rule (fst A) true_of -> good_motion (snd A) -> maps_all A.
Proof.
  intros G Gm pick path order W Gp Gw Go HW.
  destruct (explore_correct pick path order (snd A) (fst A) true_of Gp Gw Go Gm G W HW (darts W))
    as (M & b & ms & P & Iso & m & D & C); [lia|].
  exists M, b, ms, m. auto.
Qed.

(** The bound is of the order m m n, as the paper says: at most 4 m m n.
    Paper, I: The worst case is O(m²n) edge traversals. *)
Theorem bound_order m n : m * (n + (2 * m - 1) * (2 * (n - 1))) <= 4 * (m * m * n).
Proof.
  destruct m as [|m]; [lia|]. destruct n as [|n]; [nia|].
  replace (2 * S m - 1) with (2 * m + 1) by lia. replace (S n - 1) with n by lia. nia.
Qed.

(** The basic algorithm. *)
Definition basic : algorithm := (rule_none, retrace).

(** Enhancement I: prefixes. *)
Definition enhancement_i : algorithm := (rule_prefix, overlap).

(** Enhancement II: the history of this edge. *)
Definition enhancement_ii : algorithm := (rule_history, retrace).

(** Enhancement II with the motion of I. *)
Definition enhancement_ii_i : algorithm := (rule_history, overlap).

(** Enhancement III: one-level records. *)
Definition enhancement_iii_one : algorithm := (rule_records (Some 1), retrace).

(** Enhancement III, one-level, with the motion of I. *)
Definition enhancement_iii_one_i : algorithm := (rule_records (Some 1), overlap).

(** Enhancement III: all-level records. *)
Definition enhancement_iii_all : algorithm := (rule_records None, retrace).

(** Enhancement III, all-level, with the motion of I. *)
Definition enhancement_iii_all_i : algorithm := (rule_records None, overlap).

(** Listing 1: the basic algorithm maps every world within the bound.
    Paper, I, II-C: With a directional marker the world can be mapped deterministically. *)
Theorem basic_correct : maps_all basic.
Proof. apply (cost_within_bound basic _ rule_none_good retrace_good). Qed.

(** Listing 2: so does Enhancement I.
    Paper, III-A: Stage 2: the robot stays, takes the longest overlap, and walks only what is not
    shared. *)
Theorem enhancement_i_correct : maps_all enhancement_i.
Proof. apply (cost_within_bound enhancement_i _ rule_prefix_good overlap_good). Qed.

(** Section III-B of the paper: so does Enhancement II, with both motions.
    Paper, III-B: Every sequence executed for e is traced on S from the hypothesis; a mismatch
    rejects it. *)
Theorem enhancement_ii_correct : maps_all enhancement_ii /\ maps_all enhancement_ii_i.
Proof.
  split; [apply (cost_within_bound enhancement_ii _ rule_history_good retrace_good)|
    apply (cost_within_bound enhancement_ii_i _ rule_history_good overlap_good)].
Qed.

(** Section III-C of the paper: so does Enhancement III, one-level, with both motions.
    Paper, III-C: One level: the neighbours of known vertices. *)
Theorem enhancement_iii_one_correct : maps_all enhancement_iii_one /\ maps_all enhancement_iii_one_i.
Proof.
  split; [apply (cost_within_bound enhancement_iii_one _ (rule_records_good _) retrace_good)|
    apply (cost_within_bound enhancement_iii_one_i _ (rule_records_good _) overlap_good)].
Qed.

(** Listing 3: so does Enhancement III, all-level, with both motions.
    Paper, III-C: All levels: every unknown place, by relative doors from a known one. *)
Theorem enhancement_iii_all_correct : maps_all enhancement_iii_all /\ maps_all enhancement_iii_all_i.
Proof.
  split; [apply (cost_within_bound enhancement_iii_all _ (rule_records_good _) retrace_good)|
    apply (cost_within_bound enhancement_iii_all_i _ (rule_records_good _) overlap_good)].
Qed.

(** The policies of the reference costs fulfil their contracts, so that these theorems are about the
    mapper with these policies, too.
    Not in the paper. *)
Theorem reference_policies_good : good_pick nearest /\ good_path way_to /\ good_order shortest.
Proof. exact (conj nearest_good (conj way_to_good shortest_good)). Qed.
