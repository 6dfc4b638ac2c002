(** Steered mappers, 4: the budget of a run, and that each step keeps it (docs/homing.md; claim 7).

    A is what claim 7 grants for each edge, c the number of moves made, j the number of edges settled, a
    the way back to S, x, b numbers of moves; l lists hypotheses. The other letters are those of
    Steered.v.

    While the mapper chooses, the moves made and the way back are paid for by the edges that are settled,
    or those and all ways home for one more edge are, by one edge more. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment Ways Log Determined Entailed Steered
  SteeredFold SteeredMap SteeredWalk.

(** A tactic: arithmetic that takes the hypotheses times the greatest distance for one number. *)
Ltac by_numbers := repeat match goal with
  | H : context [?a * (2 * deep ?M)] |- _ => let z := fresh in set (z := a * (2 * deep M)) in *;
    clearbody z
  | |- context [?a * (2 * deep ?M)] => let z := fresh in set (z := a * (2 * deep M)) in *; clearbody z
  end; lia.

Section Runs.
Variables (W : Map) (m : nat).
Hypotheses (HW : world W) (Edges : darts W = 2 * m).
Let WW := world_is_map W HW.

(** What claim 7 grants for each edge of W. *)
Let A := grant (vertices W) m.

(** No hypothesis for e is left beside those of the list. *)
Definition covers L M T e l := forall h, h < darts M -> supposed L T e h -> In h l.

(** The way home w, begun behind e with h, goes on at p: if e ends in h, the doors w lead to the
    marker's dart from there, with a last turn k; and only then. *)
Definition homeward L (T : nat -> place) h vu p w k := forall V v, world V -> visits V L v -> exists y b,
  y < darts V /\ walk V y w = Some b /\ turn V k b = root V /\
  (dart V v vu = dart V v (T h) <-> dart V v p = y).

(** The budget of each task: the moves made, and those that it may still take. *)
Definition in_budget L M T j t := let c := length (moves L) in match t with
  | Chooses => exists a x, x < darts M /\ near L a (standing L) (T x) /\
      (c + a <= j * A \/ (exists e, open M e) /\
       c + a + vertices M + (darts M - known M - 1) * (2 * deep M) <= (j + 1) * A)
  | Behind e => open M e /\ exists p x l, on_edge L (T e) p /\ near L x (standing L) p /\
      covers L M T e l /\ c + x + length l * (2 * deep M) <= (j + 1) * A
  | Tries e h p w => open M e /\ h < darts M /\ supposed L T e h /\ length w <= vertices W /\
      exists vu b x l k, on_edge L (T e) vu /\ near L b (standing L) p /\ near L x p vu /\ valid L p /\
      covers L M T e (h :: l) /\ homeward L T h vu p w k /\
      c + b + length w + (x + length w) + length l * (2 * deep M) <= (j + 1) * A
  end.

(** The invariant of a run. *)
Definition inv s := match s with At L M T t => replays W L /\ grounded L M T /\ nothing_left L M T /\
  exists j, known M = 2 * j /\ in_budget L M T j t end.

(** An unexplored dart leaves an edge to settle. *)
Lemma edges_left L M T e j : replays W L -> grounded L M T -> open M e -> known M = 2 * j -> j + 1 <= m.
Proof.
  intros R G [He Oe] K. assert (Ex : explored M e = false) by (unfold explored; rewrite Oe; auto).
  assert (X := count_lt _ _ e He Ex). fold (known M) in X.
  destruct (grounded_le W L M T HW R G) as [Y _]. lia.
Qed.

(** The moves of a run are within the bound. *)
Lemma inv_bound L M T t : inv (At L M T t) -> length (moves L) <= m * A.
Proof.
  intros (R & G & _ & j & K & B).
  assert (One : forall e, open M e -> (j + 1) * A <= m * A).
  { intros e O. apply Nat.mul_le_mono_r, (edges_left L M T e); auto. }
  assert (All : j * A <= m * A).
  { apply Nat.mul_le_mono_r. assert (X := count_le (explored M) (darts M)). fold (known M) in X.
    destruct (grounded_le W L M T HW R G) as [Y _]. by_numbers. }
  destruct t as [|e|e h p w]; unfold in_budget in B; cbv zeta in B.
  - destruct B as (a & x & _ & _ & [B|((e & O) & B)]); [by_numbers|]. specialize (One e O). by_numbers.
  - destruct B as (O & p & x & l & _ & _ & _ & B). specialize (One e O). by_numbers.
  - destruct B as (O & _ & _ & _ & vu & b & x & l & k & _ & _ & _ & _ & _ & _ & B). specialize (One e O).
    by_numbers.
Qed.

(** All hypotheses for one edge, walked home and back, cost less than the grant. *)
Lemma grant_pays L M T n : replays W L -> grounded L M T -> n <= darts M - known M - 1 ->
  vertices M + n * (2 * deep M) <= A.
Proof.
  intros R G Hn. destruct (grounded_le W L M T HW R G) as [Ld Lv].
  assert (D := deep_lt M (g_map _ _ _ G) (g_connected _ _ _ G)). unfold A, grant.
  assert (X : n * (2 * deep M) <= (2 * m - 1) * (2 * (vertices W - 1))) by (apply Nat.mul_le_mono;
    by_numbers).
  by_numbers.
Qed.

(** What S lets the mapper believe of the grant is true. *)
Lemma grant_less L M T : replays W L -> grounded L M T ->
  grant (vertices M) ((darts M + 1) / 2) <= A.
Proof.
  intros R G. destruct (grounded_le W L M T HW R G) as [Ld Lv]. unfold A, grant.
  assert (X : (darts M + 1) / 2 <= m).
  { apply Nat.lt_succ_r, Nat.div_lt_upper_bound; by_numbers. }
  assert (Z : (2 * ((darts M + 1) / 2) - 1) * (2 * (vertices M - 1)) <=
    (2 * m - 1) * (2 * (vertices W - 1))) by (apply Nat.mul_le_mono; by_numbers).
  by_numbers.
Qed.

Section Arrives.
(** The log L was told, and all that it proves is settled: S grows from M to M'. *)
Variables (L : Log) (M M' : Map) (T T' : nat -> place) (j : nat).
Hypotheses (R : replays W L) (G : grounded L M T) (St : settles_all L M T M' T') (K : known M = 2 * j).
Let Shown := replays_shown W L HW R.

(** If e is settled now, the place behind it is in S. *)
Lemma arrives_settled e p x : open M e -> alpha M' e <> None -> on_edge L (T e) p ->
  near L x (standing L) p -> length (moves L) + x <= (j + 1) * A -> inv (At L M' T' Chooses).
Proof.
  intros O N X Nx B. destruct (settles_all_grounded L M T M' T' St Shown G)
    as (G' & Sat & D & E & Op & i & Ki & I0).
  destruct O as [He Oe]. destruct (alpha M' e) as [y|] eqn:Ey; [|tauto].
  assert (Lt : e < darts M') by by_numbers.
  assert (Hy : y < darts M') by (apply (alpha_ok M' (g_map _ _ _ G')) in Ey as (Hy & _); auto).
  split; auto. split; auto. split; auto. exists (i + j). split; [by_numbers|].
  exists x, y. split; auto. split.
  - replace x with (x + 0) by by_numbers. apply near_trans with p; auto. apply near_same.
    assert (X' := alpha_edge L M' T' Shown G' e y Lt Ey). rewrite E in X' by auto.
    destruct X as (a & b & K1 & Sa & Sb), X' as (a' & b' & K2 & Sa' & Sb').
    apply same_trans with b; auto. apply same_trans with b'; [|apply same_sym; auto].
    apply (same_link _ _ a b a' b'); auto. apply same_trans with (T e); auto. apply same_sym; auto.
  - left. assert (i <> 0) by (intros Z; destruct (I0 Z) as [-> _]; congruence).
    assert ((j + 1) * A <= (i + j) * A) by (apply Nat.mul_le_mono_r; by_numbers). by_numbers.
Qed.

(** The hypotheses for e that are left beside some, and the budget for them. *)
Lemma arrives_hypotheses e (some keep : list nat) s : open M e -> alpha M' e = None ->
  s <= (j + 1) * A ->
  (M' = M -> covers L M T e (some ++ keep) /\ s + length keep * (2 * deep M) <= (j + 1) * A) ->
  exists i l, known M' = 2 * (i + j) /\ covers L M' T' e (some ++ l) /\
    s + length l * (2 * deep M') <= (i + j + 1) * A.
Proof.
  intros O Oe' B Same. destruct (settles_all_grounded L M T M' T' St Shown G)
    as (G' & Sat & D & E & Op & i & Ki & I0).
  destruct (Nat.eq_dec i 0) as [->|N].
  - destruct (I0 eq_refl) as [-> ->]. destruct (Same eq_refl) as [C1 C2]. exists 0, keep. auto.
  - assert (O' : open M' e) by (split; auto; destruct O; by_numbers).
    destruct (other_hypotheses M' e O') as (l & Cl & Ll). exists i, l. split; [by_numbers|]. split.
    + intros h Hh S. destruct (supposed_open L M' T' G' e h O' Hh S). apply in_or_app. right.
      apply Cl; auto.
    + assert (X := grant_pays L M' T' (length l) R G' Ll).
      assert ((j + 2) * A <= (i + j + 1) * A) by (apply Nat.mul_le_mono_r; by_numbers). by_numbers.
Qed.

(** Behind e, or e is settled. *)
Lemma arrives_behind e p x : open M e -> on_edge L (T e) p -> near L x (standing L) p ->
  length (moves L) + x + (darts M - known M - 1) * (2 * deep M) <= (j + 1) * A ->
  inv (At L M' T' (next_task M' e)).
Proof.
  intros O X Nx B. unfold next_task. destruct (alpha M' e) as [y|] eqn:Ey.
  { apply arrives_settled with e p x; auto; [congruence|by_numbers]. }
  destruct (other_hypotheses M e O) as (keep & Ck & Lk).
  destruct (settles_all_grounded L M T M' T' St Shown G) as (G' & Sat & D & E & Op & _).
  destruct (arrives_hypotheses e [] keep (length (moves L) + x)) as (i & l & Ki & Cl & Bl); auto;
    [by_numbers| |].
  { intros _. split.
    - intros h Hh S. destruct (supposed_open L M T G e h O Hh S). apply Ck; auto.
    - assert (length keep * (2 * deep M) <= (darts M - known M - 1) * (2 * deep M))
        by (apply Nat.mul_le_mono_r; auto). by_numbers. }
  split; auto. split; auto. split; auto. exists (i + j). split; auto. split; [destruct O; split; auto;
    by_numbers|].
  exists p, x, l. rewrite E; auto. destruct O; auto.
Qed.
End Arrives.

(** The robot goes from where it chooses over S to any dart of it. *)
Lemma chooses_near L M T a x e : replays W L -> grounded L M T -> x < darts M -> e < darts M ->
  near L a (standing L) (T x) -> near L (a + (vertices M - 1)) (standing L) (T e).
Proof.
  intros R G Hx He N. apply near_trans with (T x); auto.
  apply near_on_s; auto. apply (replays_shown W L HW R).
Qed.

(** The budget of a choice pays for going to any dart and settling it. *)
Lemma chooses_budget L M T j e : replays W L -> grounded L M T -> in_budget L M T j Chooses ->
  open M e ->
  exists a x, x < darts M /\ near L a (standing L) (T x) /\
  length (moves L) + a + vertices M + (darts M - known M - 1) * (2 * deep M) <= (j + 1) * A.
Proof.
  intros R G (a & x & Hx & N & B) O. exists a, x. split; auto. split; auto. destruct B as [B|[_ B]];
    auto.
  assert (X := grant_pays L M T (darts M - known M - 1) R G (le_n _)). by_numbers.
Qed.

(** S has a vertex. *)
Lemma vertices_pos M : is_map M -> 1 <= vertices M.
Proof.
  intros WM. apply (vertices_most M [root M]).
  - intros a [<-|[]]. apply (root_lt M WM).
  - constructor; [intros []|constructor].
Qed.

(** The place where a door leads is one more edge away. *)
Lemma near_door L p q k x vu : possible nothing L -> on_edge L (turned k p) q -> near L x p vu ->
  near L (S x) q vu.
Proof.
  intros Shown X N. destruct (edge_valid _ _ _ X) as [P Q].
  apply near_cross with (turned k p) 0; [destruct q; apply edge_sym; auto|].
  apply near_turned; auto.
Qed.

(** A way home goes on behind its next door. *)
Lemma homeward_on L T h vu p k w q i : on_edge L (turned k p) q -> homeward L T h vu p (k :: w) i ->
  possible nothing L -> homeward L T h vu q w i.
Proof.
  intros X H Shown V v HV Vi. destruct (H V v HV Vi) as (y & b & Ly & Wk & Tb & Iff).
  assert (WV := world_is_map V HV). simpl in Wk. destruct (move V y k) as [z|] eqn:Em; [|discriminate].
  exists z, b. assert (Lz := move_lt V WV y k z Ly Em). split; auto. split; auto. split; auto.
  rewrite Iff. destruct (edge_valid _ _ _ X) as [P Q].
  assert (Al := proj1 (edge_iff L Shown _ _ P Q) X V v HV Vi). rewrite turned_dart in Al.
  unfold move in Em. destruct (k <? degree V y); [|discriminate].
  assert (Lp := dart_is V L v p Vi WV). split; intros E.
  - rewrite E in Al. congruence.
  - rewrite E in Al. apply (alpha_ok V WV) in Al as (_ & _ & Al); [|apply turn_lt; auto].
    apply (alpha_ok V WV) in Em as (_ & _ & Em); [|apply turn_lt; auto].
    apply (turn_inj V WV k); auto. congruence.
Qed.

(** It stays true when the log is longer and S larger. *)
Lemma homeward_longer L L' T T' h vu p w k : longer L L' -> T' h = T h -> homeward L T h vu p w k ->
  homeward L' T' h vu p w k.
Proof. intros Lat E H V v HV Vi. rewrite E. apply H; auto. eapply longer_visits; eauto. Qed.

(** Each step keeps the invariant. *)
Lemma step_inv s s' : inv s -> steers W s s' -> inv s'.
Proof.
  intros I St. destruct St as
    [L M T e O C|L M T e p L' O X Wt|L M T e L1 k L' M' T' O NC Wt Sk Td St
    |L M T e k L' M' T' Af Td St|L M T e p h w Hh Sp X Wh|L M T e h p k w q X
    |L M T e h p k w L1 i L' M' T' t NC Wt Sk Td St Go];
    destruct I as (R & G & Sat & j & K & B); assert (Shown := replays_shown W L HW R).
  - split; auto. split; auto. split; auto. exists j. split; auto.
    destruct (chooses_budget L M T j e R G B O) as (a & x & Hx & N & Bd). destruct C as [p X].
    split; auto. destruct (other_hypotheses M e O) as (l & Cl & Ll).
    exists p, (a + (vertices M - 1) + 1), l. split; auto.
    assert (V := vertices_pos M (g_map _ _ _ G)). split; [|split].
    + apply near_trans with (T e); [apply (chooses_near L M T a x e); auto; apply O|].
      apply near_cross with p 0; [destruct (T e); exact X|apply near_self].
    + intros h Hh S. destruct (supposed_open L M T G e h O Hh S). apply Cl; auto.
    + assert (length l * (2 * deep M) <= (darts M - known M - 1) * (2 * deep M))
        by (apply Nat.mul_le_mono_r; auto). by_numbers.
  - destruct (chooses_budget L M T j e R G B O) as (a & x & Hx & N & Bd).
    assert (V := vertices_pos M (g_map _ _ _ G)).
    destruct (goes_cost W L p L' (a + (vertices M - 1) + 1) Wt R) as (Lat & R' & Len & Nr).
    { apply near_trans with (T e); [apply (chooses_near L M T a x e); auto; apply O|].
      apply near_cross with p 0; [destruct (T e); exact X|apply near_self]. }
    assert (Shown' := replays_shown W L' HW R'). destruct (other_hypotheses M e O) as (l & Cl & Ll).
    assert (G0 := grounded_longer L L' M T Lat G). split; auto. split; auto. split.
    { destruct Wt as (n & Tr & _). apply (travels_nothing_left W n L L' M T); auto. }
    exists j. split; auto. split; auto. exists p, 0, l. split; [apply (edge_longer L L'); auto|].
    split; auto. split.
    + intros h Hh S. destruct (supposed_open L' M T G0 e h O Hh S). apply Cl; auto.
    + assert (length l * (2 * deep M) <= (darts M - known M - 1) * (2 * deep M))
        by (apply Nat.mul_le_mono_r; auto). by_numbers.
  - destruct (chooses_budget L M T j e R G B O) as (a & x & Hx & N & Bd).
    assert (V := vertices_pos M (g_map _ _ _ G)).
    destruct (goes_cost W L (T e) L1 (a + (vertices M - 1)) Wt R) as (Lat & R1 & Len & Nr).
    { apply (chooses_near L M T a x e); auto. apply O. }
    assert (R' := leaves_replays _ _ _ _ Td). assert (Shown' := replays_shown W L' HW R').
    assert (Lat' := leaves_longer _ _ _ _ Td). assert (Ln := leaves_length _ _ _ _ Td).
    assert (Ve := g_valid _ _ _ G e (proj1 O)).
    apply (arrives_behind L' M M' T T' j R' (grounded_longer L L' M T
      (longer_trans _ _ _ Lat Lat') G) St K
      e (standing L') 0); auto; [|apply near_self|by_numbers].
    destruct (leaves_edge _ _ _ _ Td) as (b & b' & Kb & Sb & Sb'). exists b, b'. split; auto. split;
      auto.
    apply same_trans with (turned k (standing L1)); auto. apply same_sym.
    apply (same_longer L1 L'); auto. apply (standing_valid L1). eapply longer_valid; eauto.
  - destruct Af as (a & x & j' & Hx & N & Kj & Bd). assert (j' = j) as -> by by_numbers.
    assert (Gr := grant_less L M T R G).
    assert (R' := leaves_replays _ _ _ _ Td). assert (Shown' := replays_shown W L' HW R').
    assert (Lat := leaves_longer _ _ _ _ Td). assert (Ln := leaves_length _ _ _ _ Td).
    assert (G0 := grounded_longer L L' M T Lat G).
    assert (Le : (j + 1) * grant (vertices M) ((darts M + 1) / 2) <= (j + 1) * A)
      by (apply Nat.mul_le_mono_l; auto).
    destruct (settles_all_grounded L' M T M' T' St Shown' G0) as (G' & Sat' & D & E & Op & i & Ki & I0).
    split; auto. split; auto. split; auto. exists (i + j). split; [by_numbers|].
    exists (S a), x. split; [by_numbers|]. rewrite E by auto. split.
    + apply near_door with (standing L) k; [auto|apply (leaves_edge _ _ _ _ Td)|].
      apply (near_longer L L'); auto; [apply standing_valid|apply G; auto].
    + destruct (Nat.eq_dec i 0) as [->|Ni].
      * destruct (I0 eq_refl) as [-> ->]. right. split; [exists e; apply B|]. simpl (0 + j).
        assert ((darts M - known M - 1) * (2 * deep M) <= (darts M - known M) * (2 * deep M))
          by (apply Nat.mul_le_mono_r; lia). by_numbers.
      * left. assert ((j + 1) * A <= (i + j) * A) by (apply Nat.mul_le_mono_r; by_numbers). by_numbers.
  - destruct B as (O & p0 & x & l & X0 & N & Cl & Bd). destruct (edge_valid _ _ _ X) as [Ve Vp].
    destruct Wh as (Lw & r & i & Wr & Tr).
    assert (Dp := deep_lt M (g_map _ _ _ G) (g_connected _ _ _ G)).
    destruct (grounded_le W L M T HW R G) as [_ Lv].
    assert (Ln := remove_length_lt Nat.eq_dec l h (Cl h Hh Sp)).
    split; auto. split; auto. split; auto. exists j. split; auto. split; auto. split; auto. split; auto.
    split; [by_numbers|]. exists p, x, 0, (remove Nat.eq_dec h l), i. split; auto.
    split; [|split; [apply near_self|split; [auto|split; [|split]]]].
    + replace x with (x + 0) by lia. apply near_trans with p0; auto. apply near_same.
      destruct X as (a & b & Ka & Sa & Sb), X0 as (a' & b' & Ka' & Sa' & Sb').
      apply same_trans with b'; auto. apply same_trans with b; [|apply same_sym; auto].
      apply (same_link _ _ a' b' a b); auto. apply same_trans with (T e); auto. apply same_sym; auto.
    + intros h' Hh' S. destruct (Nat.eq_dec h' h) as [->|Nh]; [left; auto|right].
      apply in_in_remove; auto.
    + intros V v HV Vi. assert (E := g_embedded _ _ _ G V v HV Vi).
      exists (dart V v (T h)), (dart V v (T r)). split; [apply E; auto|].
      assert (WM := g_map _ _ _ G). assert (Lr : r < darts M) by (apply (walk_lt M WM _ _ _ Hh Wr)).
      split; [apply (forward_walk M V _ WM (world_is_map V HV) E w h r); auto|].
      split; [|tauto]. rewrite <- (phi_root _ _ _ E), <- Tr.
      symmetry. apply (embedded_turn M V _ WM E); auto.
    + assert ((length (remove Nat.eq_dec h l) + 1) * (2 * deep M) <= length l * (2 * deep M))
        by (apply Nat.mul_le_mono_r; lia). lia.
  - destruct B as (O & Hh & Sp & Lw & vu & b & x & l & i & Xe & Nb & Nx & Vp & Cl & Hw & Bd).
    destruct (edge_valid _ _ _ X) as [_ Vq]. simpl length in *.
    split; auto. split; auto. split; auto. exists j. split; auto. split; auto. split; auto. split; auto.
    split; [by_numbers|]. exists vu, (b + 1), (S x), l, i. split; auto.
    split; [|split; [|split; [auto|split; [auto|split]]]].
    + apply near_trans with p; auto. apply near_cross with q k; auto. apply near_self.
    + apply near_door with p k; auto.
    + apply homeward_on with p k; auto.
    + by_numbers.
  - destruct B as (O & Hh & Sp & Lw & vu & b & x & l & i' & Xe & Nb & Nx & Vp & Cl & Hw & Bd).
    simpl length in *. destruct (goes_cost W L p L1 b Wt R Nb) as (Lat1 & R1 & Len & _).
    assert (R' := leaves_replays _ _ _ _ Td). assert (Shown' := replays_shown W L' HW R').
    assert (Lat' := leaves_longer _ _ _ _ Td). assert (Ln := leaves_length _ _ _ _ Td).
    assert (Lat := longer_trans _ _ _ Lat1 Lat'). assert (G0 := grounded_longer L L' M T Lat G).
    destruct (edge_valid _ _ _ Xe) as [Ve Vvu].
    assert (Xk : on_edge L' (turned k p) (standing L')).
    { destruct (leaves_edge _ _ _ _ Td) as (c & c' & Kc & Sc & Sc'). exists c, c'. split; auto. split;
      auto.
      apply same_trans with (turned i (standing L1)); auto. apply same_sym.
      apply (same_longer L1 L'); auto; [apply (standing_valid L1)|eapply longer_valid; eauto]. }
    assert (Xe' := edge_longer L L' Lat Shown' _ _ Xe).
    assert (Nv : near L' (S x) (standing L') vu).
    { apply near_door with p k; auto. apply (near_longer L L'); auto. }
    destruct (settles_all_grounded L' M T M' T' St Shown' G0) as (G' & Sat' & D & E & Op & _).
    assert (Cl' : covers L' M T e (h :: l)).
    { intros h' Hh' S. apply Cl; auto. apply (supposed_longer L L'); auto; apply (g_valid _ _ _ G);
      auto. }
    destruct Go as [Ne|Oe Rf|Oe Sp'].
    + apply (arrives_settled L' M M' T T' j R' G0 St K e vu (S x)); auto. by_numbers.
    + destruct (arrives_hypotheses L' M M' T T' j R' G0 St K e [] l (length (moves L') + S x))
        as (i2 & l' & Ki & Cl2 & Bl); auto; [by_numbers| |].
      { intros ->. split; [|by_numbers]. intros h' Hh' S. destruct (Cl' h' Hh' S) as [<-|I]; auto.
        destruct Rf. unfold supposed. rewrite !E; auto. apply O. }
      split; auto. split; auto. split; auto. exists (i2 + j). split; auto.
      split; [destruct O; split; auto; lia|]. exists vu, (S x), l'. rewrite E; auto. apply O.
    + destruct (arrives_hypotheses L' M M' T T' j R' G0 St K e [h] l
        (length (moves L') + 0 + length w + (S x + length w))) as (i2 & l' & Ki & Cl2 & Bl); auto;
        [by_numbers| |].
      { intros ->. split; [auto|by_numbers]. }
      split; auto. split; auto. split; auto. exists (i2 + j). split; auto.
      split; [destruct O; split; auto; lia|]. split; [lia|]. split; auto. split; [lia|].
      exists vu, 0, (S x), l', i'. rewrite E by apply O. split; auto. split; [apply near_self|].
      split; auto. split; [apply standing_valid|]. split; [auto|]. split; [|auto].
      apply homeward_on with p k; auto. apply homeward_longer with L T; auto.
Qed.
End Runs.
