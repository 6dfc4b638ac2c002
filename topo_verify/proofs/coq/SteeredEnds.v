(** Steered mappers, 5: they end in every world with the right map, within the bound of claim 7
    (docs/homing.md; claims 5, 7 and 9).

    The letters are those of Steered.v. [homing] and [planner] are steered mappers, so their weights
    affect only the cost. *)
From Coq Require Import Arith Lia List Bool Wf_nat.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment Program Mapper Ways Algorithms Log
  Determined Undetermined Entailed Sound Steered SteeredFold SteeredMap SteeredWalk SteeredRun.

Section Ends.
Variables (W : Map) (m : nat).
Hypotheses (HW : world W) (Edges : darts W = 2 * m).
Let WW := world_is_map W HW.
Let A := grant (vertices W) m.
Notation inv := (inv W m).
Notation in_budget := (in_budget W m).

(** The invariant holds at the start. *)
Lemma opening_inv : inv (opening W).
Proof.
  assert (Hr := root_lt W WW). destruct (degree_spec W WW _ Hr) as (D & _).
  split; [split; auto|]. split; [split|split].
  - apply is_map_initial; auto.
  - apply connected_initial; auto.
  - intros x _. discriminate.
  - intros V v HV Vi. assert (P := v_seen _ _ _ Vi 0 _ eq_refl). rewrite (v_0 _ _ _ Vi) in P.
    injection P as P _. rewrite <- P. apply embedded_ext with (2 := embedded_initial V
      (world_is_map V HV)).
    + apply is_map_initial. rewrite P. auto.
    + intros x _. unfold dart. simpl. rewrite (v_0 _ _ _ Vi). auto.
  - intros M' T' St.
    assert (No : forall p q, ~ on_edge {| start := percept W (root W); moves := [] |} p q).
    { intros p q (a & b & K & _). destruct K as [[|i] k K|[|i] k K|x y []|x y []]; discriminate. }
    inversion St; subst; eapply No; eauto.
  - exists 0. split.
    + unfold known, explored. simpl. clear. induction (degree W (root W)) as [|n IH]; auto.
    + exists 0, 0. split; [exact D|]. split; [apply near_self|left; simpl; lia].
Qed.

(** Every state of a run keeps the invariant. *)
Lemma runs_inv s : runs W s -> inv s.
Proof. induction 1; [apply opening_inv|eapply step_inv; eauto]. Qed.

(** From the vertex of p the robot can leave by any dart. *)
Lemma can_leave L p k : replays W L -> near L 0 (standing L) p -> valid L p ->
  exists j L', same nothing L (turned j (standing L)) (turned k p) /\ leaves_by W L j L'.
Proof.
  intros R N P. assert (Shown := replays_shown W L HW R). inversion N as [? ? ? i S|]; subst.
  destruct (turned_mod L Shown (k + i) (standing L) (standing_valid L)) as (j & Sj & Lt).
  destruct (replays_visits W L WW R) as [v V]. destruct (leaves_exists W L v j HW R V) as (L' & Td).
  { apply (Lt W v HW V). }
  exists j, L'. split; auto. apply same_trans with (turned (k + i) (standing L)); [apply same_sym;
    auto|].
  rewrite <- turned_turned. apply turned_same; auto.
Qed.

(** Where the way home ends, e is settled or h refuted: a way home in tries never ends. *)
Lemma home_reached L M T j e h p : replays W L -> grounded L M T -> nothing_left L M T ->
  ~ in_budget L M T j (Tries e h p []).
Proof.
  intros R G Sat (O & Hh & Sp & _ & vu & b & x & l & k & Xe & _ & Nx & Vp & _ & Hw & _).
  assert (Shown := replays_shown W L HW R). apply (Sat (augment_loop M e h) T), settles_loop; auto.
  destruct (edge_valid _ _ _ Xe) as [Ve Vvu]. assert (Al := proj1 (edge_iff L Shown _ _ Ve Vvu) Xe).
  assert (Home : same nothing L (turned k p) (0, 0)).
  { apply consistent_possible in Sp as (V & v & HV & Vi & F).
    destruct (Hw V v HV Vi) as (y & c & _ & Wy & Ty & Iff). simpl in Wy. injection Wy as <-.
    apply (home V L v HV Vi); auto. rewrite turned_dart, <- Ty. f_equal. apply Iff.
    assert (E := F (T e) (T h) (or_introl eq_refl)). rewrite (Al V v HV Vi) in E. congruence. }
  apply edge_iff; auto; [apply G; auto|]. intros V v HV Vi. rewrite (Al V v HV Vi). f_equal.
  destruct (Hw V v HV Vi) as (y & c & Ly & Wy & Ty & Iff). simpl in Wy. injection Wy as <-.
  apply Iff. assert (WV := world_is_map V HV). apply (turn_inj V WV k); auto; [apply (dart_is V L);
    auto|].
  rewrite Ty, <- turned_dart.
  rewrite (same_sound V L v nothing HV Vi (fits_nothing V v) _ _ Home). apply (v_0 _ _ _ Vi).
Qed.

(** The mapper stops, or goes on. *)
Lemma inv_goes_on s : inv s -> stops s \/ exists s', steers W s s'.
Proof.
  destruct s as [L M T t]. intros (R & G & Sat & j & K & B). assert (Shown := replays_shown W L HW R).
  destruct t as [|e|e h p w].
  - destruct (open_or_closed M) as [(e & O)|C].
    2: { left. split; auto. intros e [He Oe]. apply (C e He Oe). }
    right. destruct (chooses_budget W m HW Edges L M T j e R G B O) as (a & x & Hx & N & _).
    assert (Ve := g_valid _ _ _ G e (proj1 O)).
    destruct (crossed_can_tell L Shown (T e) Ve) as [X|X].
    { eexists. apply step_beside; eauto. }
    destruct (goes_exists W (a + (vertices M - 1)) L (T e) HW R) as (L1 & Wt); auto.
    { apply (chooses_near W HW L M T a x e); auto. apply O. }
    destruct (goes_cost W L (T e) L1 (a + (vertices M - 1)) Wt R) as (Lat & R1 & _ & N1).
    { apply (chooses_near W HW L M T a x e); auto. apply O. }
    destruct (can_leave L1 (T e) 0 R1 N1) as (k & L' & Sk & Td); [eapply longer_valid; eauto|].
    destruct (settles_all_exists W L' HW (leaves_replays _ _ _ _ Td) M T) as (M' & T' & St).
    { apply (grounded_longer L L'); auto. apply (longer_trans _ _ _ Lat (leaves_longer _ _ _ _ Td)). }
    eexists. eapply step_cross; eauto. destruct (T e). exact Sk.
  - right. destruct B as (O & p & x & l & X & _). destruct (edge_valid _ _ _ X) as [Ve Vp].
    assert (Vt := g_valid _ _ _ G).
    destruct (can_tell_list (fun h => supposed L T e h) (seq 0 (darts M))) as [(h & Ih & S)|N].
    + intros h Ih. apply in_seq in Ih. apply consistent_can_tell; auto. apply Vt. lia.
    + apply in_seq in Ih. destruct (home_exists M h (g_map _ _ _ G) (g_connected _ _ _ G)) as (w & Wh);
        [lia|]. eexists. eapply step_try; eauto. lia.
    + exfalso. unfold valid in Vp. destruct (seen L (fst p)) as [(d, i)|] eqn:E; [|tauto].
      eapply Sat. apply (settles_new L M T e p d i); auto.
      intros h Hh S. apply N. exists h. split; auto. apply in_seq. lia.
  - right. destruct w as [|k w].
    { destruct (home_reached L M T j e h p R G Sat B). }
    destruct B as (O & Hh & Sp & Lw & vu & b & x & l & i & Xe & Nb & Nx & Vp & _).
    destruct (crossed_can_tell L Shown (turned k p) Vp) as [[q X]|X].
    { eexists. apply step_known; eauto. }
    destruct (goes_exists W b L p HW R Nb Vp) as (L1 & Wt).
    destruct (goes_cost W L p L1 b Wt R Nb) as (Lat & R1 & _ & N1).
    destruct (can_leave L1 p k R1 N1) as (i1 & L' & Sk & Td); [eapply longer_valid; eauto|].
    assert (R' := leaves_replays _ _ _ _ Td).
    assert (G0 := grounded_longer L L' M T (longer_trans _ _ _ Lat (leaves_longer _ _ _ _ Td)) G).
    destruct (settles_all_exists W L' HW R' M T G0) as (M' & T' & St).
    assert (Shown' := replays_shown W L' HW R').
    destruct (settles_all_grounded L' M T M' T' St Shown' G0) as (G' & _ & D & _).
    assert (Go : exists t, goes_on L' M' T' e h w t).
    { destruct (alpha M' e) as [y|] eqn:Ey; [eexists; apply goes_on_settled; congruence|].
      destruct (consistent_can_tell L' Shown' (T' e) (T' h)) as [S|S].
      - apply (g_valid _ _ _ G'). destruct O. lia.
      - apply (g_valid _ _ _ G'). lia.
      - eexists. apply goes_on_home; auto.
      - eexists. apply goes_on_refuted; auto. }
    destruct Go as (t & Go). eexists. eapply step_home; eauto.
Qed.

(** What is left of a run: moves within the bound, and steps that make none. *)
Definition steps_left s := match s with At L M T t => (m * A - length (moves L)) *
  (vertices W + 3) + match t with
  | Chooses => vertices W + 2 | Behind _ => vertices W + 1 | Tries _ _ _ w => length w end end.

(** Each step leaves less. *)
Lemma step_less s s' : inv s -> steers W s s' -> steps_left s' < steps_left s.
Proof.
  intros I St. assert (I' := step_inv W m HW Edges s s' I St).
  assert (Less : forall L M T t L' M' T' t', inv (At L' M' T' t') ->
    length (moves L) < length (moves L') ->
    steps_left (At L' M' T' t') < steps_left (At L M T t)).
  { intros L M T t L' M' T' t' J Lt. assert (Bd := inv_bound W m HW Edges L' M' T' t' J).
    destruct J as (_ & _ & _ & j & _ & B). unfold steps_left.
    assert (Rk : match t' with Chooses => vertices W + 2 | Behind _ => vertices W + 1
      | Tries _ _ _ w => length w end <= vertices W + 2).
    { destruct t' as [| |e h p w]; try lia. destruct B as (_ & _ & _ & B & _). lia. }
    assert ((m * A - length (moves L') + 1) * (vertices W + 3) <=
      (m * A - length (moves L)) * (vertices W + 3)) by (apply Nat.mul_le_mono_r; lia). lia. }
  destruct St as
    [L M T e O C|L M T e p L' O X Wt|L M T e L1 k L' M' T' O NC Wt Sk Td St
    |L M T e k L' M' T' Af Td St|L M T e p h w Hh Sp X Wh|L M T e h p k w q X
    |L M T e h p k w L1 i L' M' T' t NC Wt Sk Td St Go].
  - unfold steps_left. lia.
  - destruct Wt as (n & Tr & _). destruct (travels_longer _ _ _ _ Tr) as (_ & Len & _).
    destruct n as [|n]; [|apply Less; auto; lia]. inversion Tr; subst. unfold steps_left. lia.
  - destruct Wt as (n & Tr & _). destruct (travels_longer _ _ _ _ Tr) as (_ & Len & _).
    assert (Ln := leaves_length _ _ _ _ Td). apply Less; auto. lia.
  - assert (Ln := leaves_length _ _ _ _ Td). apply Less; auto. lia.
  - destruct I' as (_ & _ & _ & j & _ & (_ & _ & _ & Lw & _)). unfold steps_left. lia.
  - unfold steps_left. simpl length. lia.
  - destruct Wt as (n & Tr & _). destruct (travels_longer _ _ _ _ Tr) as (_ & Len & _).
    assert (Ln := leaves_length _ _ _ _ Td). apply Less; auto. lia.
Qed.
End Ends.

(** A world has an even number of darts. *)
Lemma even_darts W : world W -> exists m, darts W = 2 * m.
Proof.
  intros HW. destruct reference_policies_good as (Gp & Gw & Go).
  destruct (basic_correct _ _ _ W Gp Gw Go HW) as (M & b & ms & m & _ & _ & D & _). eauto.
Qed.

(** Claim 7 for steered mappers: at any moment of any run the mapper has made at most
    m (n + (2m - 1) 2(n - 1)) moves, whatever it chose.
    Not in the paper. *)
Theorem steered_bound W m L M T t : world W -> darts W = 2 * m -> runs W (At L M T t) ->
  length (moves L) <= m * (vertices W + (2 * m - 1) * (2 * (vertices W - 1))).
Proof.
  intros HW Ed Rn. apply (inv_bound W m HW Ed L M T t), (runs_inv W m HW Ed), Rn.
Qed.

(** Claims 5, 7 and 9 for steered mappers: where one stops, S is the world, the log proves it, and at
    least m moves were made.
    Not in the paper. *)
Theorem steered_right W m L M T t : world W -> darts W = 2 * m -> runs W (At L M T t) ->
  stops (At L M T t) -> isomorphic M W /\ replays W L /\ closed L /\ m <= length (moves L).
Proof.
  intros HW Ed Rn [_ C]. destruct (runs_inv W m HW Ed _ Rn) as (R & G & _).
  assert (Iso : forall V, world V -> replays V L -> isomorphic M V).
  { intros V HV RV. destruct (replays_visits V L (world_is_map V HV) RV) as [v Vi].
    apply (closed_isomorphic M V _ (g_map _ _ _ G) (g_embedded _ _ _ G V v HV Vi)).
    - apply HV.
    - intros d Hd Od. apply (C d). split; auto. }
  split; [apply Iso; auto|]. split; auto.
  assert (Cl : closed L).
  { destruct (closed_or_undetermined W L HW R) as [Cl|(W1 & W2 & H1 & H2 & R1 & R2 & N)]; auto.
    destruct N. rewrite <- (proj1 (Iso W1 H1 R1)). apply (Iso W2 H2 R2). }
  split; auto. assert (X := closed_cost W L HW R Cl). lia.
Qed.

(** A steered mapper that has not stopped can always go on.
    Not in the paper. *)
Theorem steered_goes_on W s : world W -> runs W s -> stops s \/ exists s', steers W s s'.
Proof.
  intros HW Rn. destruct (even_darts W HW) as (m & Ed).
  apply (inv_goes_on W m HW Ed), (runs_inv W m HW Ed), Rn.
Qed.

(** Steered mappers end in every world, whatever they choose: next is any choice among the steps.
    Not in the paper. *)
Theorem steered_ends W (next : situation -> situation) : world W ->
  (forall s, runs W s -> ~ stops s -> steers W s (next s)) ->
  exists i, runs W (Nat.iter i next (opening W)) /\ stops (Nat.iter i next (opening W)).
Proof.
  intros HW Next. destruct (even_darts W HW) as (m & Ed).
  cut (forall s, runs W s -> exists i, runs W (Nat.iter i next s) /\ stops (Nat.iter i next s)).
  { intros H. apply H. apply runs_opening. }
  intros s. remember (steps_left W m s) as n eqn:En. revert s En.
  induction n as [n IH] using lt_wf_ind. intros s -> Rn.
  assert (D : stops s \/ ~ stops s).
  { destruct s as [L M T t]. destruct (open_or_closed M) as [(e & O)|C].
    - right. intros [_ N]. apply (N e O).
    - destruct t as [| |]; [left|right; intros [E _]; discriminate..]. split; auto.
      intros e [He Oe]. apply (C e He Oe). }
  destruct D as [D|D]; [exists 0; auto|]. assert (St := Next s Rn D).
  assert (Rn' := runs_step W s _ Rn St).
  destruct (IH (steps_left W m (next s))) with (s := next s) as (i & H); auto.
  - apply (step_less W m HW Ed); auto. apply (runs_inv W m HW Ed); auto.
  - exists (S i). replace (Nat.iter (S i) next s) with (Nat.iter i next (next s)); auto.
    clear. induction i as [|i IH]; simpl in *; congruence.
Qed.
