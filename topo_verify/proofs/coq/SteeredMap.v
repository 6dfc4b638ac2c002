(** Steered mappers, 2: S follows from the log, and settling keeps it so.

    L, L' are logs, the second one longer; M the map S, T the places of its darts; e, h darts of S, p, q
    places; W, V worlds, v i the reference dart of visit i.

    The invariant is [grounded]: in every world that shows the log, S is embedded at the places of its
    darts. *)
From Coq Require Import Arith Lia List Bool Wf_nat.
Import ListNotations.
From Topo Require Import World Rotation Embedding Vertices Augment Ways Log Determined Entailed LogFold
  LogFoldExact FoldingRule Steered SteeredFold.

(** L' is L with more moves behind. *)
Definition longer L L' := exists ns, L' = {| start := start L; moves := moves L ++ ns |}.

(** A log begins with itself. *)
Lemma longer_refl L : longer L L.
Proof. exists []. rewrite app_nil_r. destruct L. auto. Qed.

(** Beginning with a log is transitive. *)
Lemma longer_trans A B C : longer A B -> longer B C -> longer A C.
Proof. intros [l ->] [k ->]. exists (l ++ k). simpl. rewrite app_assoc. auto. Qed.

(** A move makes the log longer, *)
Lemma leaves_longer W L k L' : leaves_by W L k L' -> longer L L'.
Proof. intros (q & -> & _). exists [(k, q)]. auto. Qed.

(** A world that shows a longer log shows the log. *)
Lemma longer_visits W L L' v : longer L L' -> visits W L' v -> visits W L v.
Proof. intros [ns ->]. apply visits_before. Qed.

(** Places of a log are places of a longer one. *)
Lemma longer_valid L L' p : longer L L' -> valid L p -> valid L' p.
Proof.
  intros [ns ->]. unfold valid, seen. simpl. rewrite map_app.
  destruct (fst p) as [|i]; simpl; auto. intros V E. apply V, nth_error_None.
  apply nth_error_None in E. rewrite app_length in E. lia.
Qed.

(** The robot's place is one of the log. *)
Lemma standing_valid L : valid L (standing L).
Proof.
  unfold valid, seen, standing. simpl. apply nth_error_Some. simpl. rewrite map_length. lia.
Qed.

Section Longer.
Variables (L L' : Log).
Hypotheses (Lat : longer L L') (Shown' : possible nothing L').

(** Some world shows the shorter log. *)
Lemma longer_shown : possible nothing L.
Proof.
  destruct Shown' as (W & v & HW & V & _). exists W, v. split; auto. split; [|apply fits_nothing].
  eapply longer_visits; eauto.
Qed.

(** What is identified stays identified. *)
Lemma same_longer p q : valid L p -> valid L q -> same nothing L p q -> same nothing L' p q.
Proof.
  intros P Q S. apply same_iff; eauto using longer_valid. intros W v HW V.
  apply (same_iff L longer_shown p q P Q); auto. eapply longer_visits; eauto.
Qed.

(** Edges of the fold stay. *)
Lemma edge_longer p q : on_edge L p q -> on_edge L' p q.
Proof.
  intros X. destruct (edge_valid _ _ _ X) as [P Q]. apply edge_iff; eauto using longer_valid.
  intros W v HW V. apply (edge_iff L longer_shown p q P Q); auto. eapply longer_visits; eauto.
Qed.

(** Ways stay. *)
Lemma near_longer n p q : valid L p -> valid L q -> near L n p q -> near L' n p q.
Proof.
  intros P Q N. induction N as [n p q k S|n p q r k X N IH].
  - apply near_here with k. apply same_longer; auto.
  - apply near_cross with q k; [apply edge_longer; auto|]. apply IH; auto. apply edge_valid in X. tauto.
Qed.

(** What is refuted stays refuted. *)
Lemma supposed_longer p q : valid L p -> valid L q -> consistent [(p, q)] L' -> consistent [(p, q)] L.
Proof.
  intros P Q C. apply consistent_possible in C as (W & v & HW & V & F).
  apply possible_consistent; [intros a b [I|[]]; injection I as <- <-; auto|].
  exists W, v. split; auto. split; auto. eapply longer_visits; eauto.
Qed.
End Longer.

(** A log with one more move has its edge. *)
Lemma leaves_edge W L k L' : leaves_by W L k L' -> on_edge L' (turned k (standing L)) (standing L').
Proof.
  intros (q & -> & _). exists (length (moves L), k), (S (length (moves L)), 0). split; [|split].
  - apply link_out. unfold door. simpl. rewrite map_app, nth_error_app2; rewrite map_length; auto.
    rewrite Nat.sub_diag. auto.
  - unfold turned, standing. simpl. rewrite Nat.add_0_r. constructor.
  - unfold standing. simpl. rewrite app_length. simpl. rewrite Nat.add_1_r. constructor.
Qed.

(** by one move, *)
Lemma leaves_length W L k L' : leaves_by W L k L' -> length (moves L') = S (length (moves L)).
Proof. intros (q & -> & _). simpl. rewrite app_length. simpl. lia. Qed.

(** and the world shows it. *)
Lemma leaves_replays W L k L' : leaves_by W L k L' -> replays W L'.
Proof. intros (q & _ & R). auto. Qed.

(** A log that the world W shows is one that some world shows. *)
Lemma replays_shown W L : world W -> replays W L -> possible nothing L.
Proof.
  intros HW R. apply replays_visits in R as [v V]; [|apply HW]. exists W, v.
  auto using fits_nothing.
Qed.

(** A door that exists can be taken. *)
Lemma leaves_exists W L v k : world W -> replays W L -> visits W L v ->
  k < degree W (v (length (moves L))) ->
  exists L', leaves_by W L k L'.
Proof.
  intros HW [Rs Rp] V Hk. assert (WW := world_is_map W HW).
  destruct (move W (v (length (moves L))) k) as [b|] eqn:Em.
  - eexists. exists (percept W b). split; [reflexivity|]. split; auto. simpl.
    rewrite !map_app. assert (E := visits_end W L v V). simpl.
    set (c := v (length (moves L))) in *. clearbody c. clear - Rp E Em. revert Rp E.
    generalize (root W). induction (moves L) as [|(j, o) ms IH]; simpl.
    + intros a _ E. injection E as E. rewrite E, Em. auto.
    + intros a. destruct (move W a j) as [a'|]; [|discriminate].
      destruct (percepts W a' (map fst ms)) as [ps|] eqn:P; [|discriminate]. simpl. intros H E.
      injection H as Ho Hp. rewrite (IH a'); [simpl; congruence|congruence|auto].
  - unfold move in Em. rewrite (proj2 (Nat.ltb_lt _ _) Hk) in Em.
    destruct (world_total W HW (turn W k (v (length (moves L))))); auto.
    apply turn_lt; auto. apply (v_lt _ _ _ V).
Qed.

(** S follows from the log: in every world that shows the log, S is embedded at the places of its
    darts. *)
Record grounded L M (T : nat -> place) : Prop := {
  g_map : is_map M;
  g_connected : connected M;
  g_valid : forall x, x < darts M -> valid L (T x);
  g_embedded : forall W v, world W -> visits W L v -> embedded M W (fun x => dart W v (T x)) }.

(** S follows from a longer log, too. *)
Lemma grounded_longer L L' M T : longer L L' -> grounded L M T -> grounded L' M T.
Proof.
  intros Lat G. split; try apply G.
  - intros x Hx. eapply longer_valid; eauto. apply G; auto.
  - intros W v HW V. apply G; auto. eapply longer_visits; eauto.
Qed.

(** An embedding depends on the darts of the map only. *)
Lemma embedded_ext M W phi psi : is_map M -> embedded M W phi ->
  (forall x, x < darts M -> psi x = phi x) -> embedded M W psi.
Proof.
  intros WM [A B C D E] H. split.
  - intros d Hd. rewrite H; auto.
  - intros d e Hd He. rewrite !H; auto.
  - intros d Hd. rewrite !H; auto. apply (sigma_lt M WM); auto.
  - intros d e Hd He. assert (e < darts M) by (apply (alpha_ok M WM) in He as (He & _);
    auto). rewrite !H; auto.
  - rewrite H; auto. apply (root_lt M WM).
Qed.

Section Grounded.
Variables (L : Log) (M : Map) (T : nat -> place).
Hypotheses (Shown : possible nothing L) (G : grounded L M T).

(** In a world in which an unexplored dart e ends in dart h of S, h is another unexplored dart. *)
Lemma end_open W v e h : world W -> visits W L v -> open M e -> h < darts M ->
  alpha W (dart W v (T e)) = Some (dart W v (T h)) -> h <> e /\ alpha M h = None.
Proof.
  intros HW V [He Oe] Hh E.
  destruct (posed M W (fun x => dart W v (T x)) (g_map _ _ _ G) (world_is_map W HW)
    (g_embedded _ _ _ G W v HW V) e _ h He Oe E Hh eq_refl) as (A & B & _). auto.
Qed.

(** So is a hypothesis that is not refuted. *)
Lemma supposed_open e h : open M e -> h < darts M -> supposed L T e h -> h <> e /\ alpha M h = None.
Proof.
  intros Oe Hh C. apply consistent_possible in C as (W & v & HW & V & F).
  apply (end_open W v e h); auto. apply F. simpl. auto.
Qed.

(** Explored edges of S are edges of the fold. *)
Lemma alpha_edge x y : x < darts M -> alpha M x = Some y -> on_edge L (T x) (T y).
Proof.
  intros Hx E. assert (Hy : y < darts M)
    by (apply (alpha_ok M (g_map _ _ _ G)) in E as (Hy & _); auto).
  apply edge_iff; auto; try (apply G; auto; fail). intros W v HW V.
  apply (phi_alpha _ _ _ (g_embedded _ _ _ G W v HW V)); auto.
Qed.

(** Turning on S is turning in the fold. *)
Lemma turned_in_s k x : x < darts M -> same nothing L (turned k (T x)) (T (turn M k x)).
Proof.
  intros Hx. assert (WM := g_map _ _ _ G). apply same_iff; auto; try (apply G; auto using turn_lt; fail).
  intros W v HW V. rewrite turned_dart. symmetry.
  apply (embedded_turn M W _ WM (g_embedded _ _ _ G W v HW V)); auto.
Qed.

(** A walk on S is a way in the fold. *)
Lemma walk_near w : forall x y, x < darts M -> walk M x w = Some y -> near L (length w) (T x) (T y).
Proof.
  assert (WM := g_map _ _ _ G). induction w as [|k w IH]; simpl; intros x y Hx E.
  - injection E as <-. apply near_self.
  - destruct (move M x k) as [z|] eqn:Em; [|discriminate].
    assert (Hz := move_lt M WM x k z Hx Em).
    unfold move in Em. destruct (k <? degree M x); [|discriminate].
    apply near_cross with (T z) k; [|apply IH; auto].
    destruct (alpha_edge (turn M k x) z) as (a & b & K & Sa & Sb); auto using turn_lt.
    exists a, b. split; auto. split; auto. apply same_trans with (T (turn M k x)); auto.
    apply turned_in_s; auto.
Qed.

(** From one dart of S to another it is less than as many moves as S has vertices. *)
Lemma near_on_s x y : x < darts M -> y < darts M -> near L (vertices M - 1) (T x) (T y).
Proof.
  intros Hx Hy. assert (WM := g_map _ _ _ G).
  destruct (way_to_good M x y WM (g_connected _ _ _ G) Hx Hy) as (Len & q & Wk & _ & Tq).
  assert (Hq : q < darts M) by (apply (walk_lt M WM _ _ _ Hx Wk)).
  apply near_more with (length (fst (way_to M y x)) + 0); [|lia].
  apply near_trans with (T q); [apply walk_near; auto|].
  apply near_here with (snd (way_to M y x)). rewrite <- Tq at 2. apply turned_in_s; auto.
Qed.

(** What is settled is right in every world that shows the log. *)
Lemma settles_grounded M' T' : settles L M T M' T' ->
  grounded L M' T' /\ known M' = 2 + known M /\ darts M <= darts M' /\
  (forall x, x < darts M -> T' x = T x) /\ forall e, alpha M' e = None -> e < darts M ->
    alpha M e = None.
Proof.
  assert (WM := g_map _ _ _ G). intros St. revert G.
  destruct St as [M T e h [He Oe] Hh X|M T e p d m [He Oe] X E Ref]; intros G0.
  - assert (Al : forall W v, world W -> visits W L v -> alpha W (dart W v (T e)) = Some (dart W v (T h)))
      by (apply edge_iff; auto; apply G0; auto).
    assert (Oh : h <> e /\ alpha M h = None).
    { destruct Shown as (W & v & HW & V & _).
      destruct (posed M W (fun x => dart W v (T x)) (g_map _ _ _ G0) (world_is_map W HW)
        (g_embedded _ _ _ G0 W v HW V) e _ h He Oe (Al W v HW V) Hh eq_refl) as (A & B & _). auto. }
    destruct Oh as [Nh Oh]. split; [split|split; [|split; [|split]]].
    + apply is_map_loop; auto.
    + apply connected_loop; auto. all: try apply (g_connected _ _ _ G0).
    + apply G0.
    + intros W v HW V. apply embedded_loop; auto; [apply HW|apply G0; auto].
    + apply loop_two_more; auto.
    + simpl. auto.
    + auto.
    + intros x. simpl. unfold join. intros N Hx. cases; auto.
  - destruct (edge_valid _ _ _ X) as [_ P].
    assert (Al : forall W v, world W -> visits W L v -> alpha W (dart W v (T e)) = Some (dart W v p))
      by (apply edge_iff; auto; apply G0; auto).
    assert (De : forall W v, world W -> visits W L v -> degree W (dart W v p) = d).
    { intros W v HW V. unfold dart. rewrite degree_turn; [|apply HW|apply (v_lt _ _ _ V)].
      apply (v_seen _ _ _ V) in E. injection E as E _. auto. }
    assert (Pd : 0 < d) by (apply (proj1 (c_percept _ _ (plain L Shown) _ _ _ E))).
    split; [split|split; [|split; [|split]]].
    + apply is_map_new; auto.
    + apply connected_new; auto. all: try apply (g_connected _ _ _ G0). all: try apply (g_map _ _ _ G0).
    + simpl. intros x Hx. destruct (x <? darts M) eqn:C; [|exact P].
      apply Nat.ltb_lt in C. apply G0; auto.
    + intros W v HW V. assert (WW := world_is_map W HW). assert (Em := g_embedded _ _ _ G0 W v HW V).
      assert (N : embedded (augment_new M e (degree W (dart W v p))) W
        (extend (fun x => dart W v (T x)) (darts M) W (dart W v p))).
      { apply embedded_new; auto. intros h Hh Eh. apply (Ref h Hh).
        apply possible_consistent.
        - intros a b [I|[]]. injection I as <- <-. split; apply G0; auto.
        - exists W, v. split; auto. split; auto. intros a b [I|[]]. injection I as <- <-.
          rewrite Eh. auto. }
      rewrite De in N by auto. apply embedded_ext with (2 := N).
      * apply is_map_new; auto.
      * intros x _. unfold extend. destruct (x <? darts M); auto. apply turned_dart.
    + apply new_two_more; auto.
    + simpl. lia.
    + intros x Hx. apply Nat.ltb_lt in Hx. rewrite Hx. auto.
    + intros x. simpl. unfold join. intros N Hx. cases; auto.
Qed.
End Grounded.

(** Whether something can be settled is decided by the fold. *)
Lemma settles_can_tell L M T : possible nothing L -> grounded L M T ->
  can_tell (exists M' T', settles L M T M' T').
Proof.
  intros Shown G. assert (Val := g_valid _ _ _ G).
  set (P e := alpha M e = None /\ ((exists h, In h (seq 0 (darts M)) /\ on_edge L (T e) (T h)) \/
    (exists r, In r (arcs_of_moves 0 (moves L)) /\ same nothing L (T e) (fst r)) /\
    ~ (exists h, In h (seq 0 (darts M)) /\ supposed L T e h))).
  assert (In_seq : forall x, In x (seq 0 (darts M)) <-> x < darts M) by (intros x; rewrite in_seq; lia).
  destruct (can_tell_list P (seq 0 (darts M))) as [(e & Ie & Oe & [(h & Ih & X)|[(r & Ir & S) N]])|N].
  - intros e Ie. apply In_seq in Ie. unfold P. destruct (alpha M e) as [y|] eqn:Oe.
    { right. intros [E _]. discriminate. }
    destruct (can_tell_list (fun h => on_edge L (T e) (T h)) (seq 0 (darts M))) as [X|X].
    { intros h Ih. apply In_seq in Ih. apply edge_can_tell; auto. }
    { left. auto. }
    destruct (can_tell_list (fun r => same nothing L (T e) (fst r)) (arcs_of_moves 0 (moves L)))
      as [Y|Y].
    { intros (a, b) I. apply same_can_tell; auto. apply arcs_links in I. eapply link_valid; eauto. }
    2: { right. intros [_ [X'|[Y' _]]]; auto. }
    destruct (can_tell_list (fun h => supposed L T e h) (seq 0 (darts M))) as [Z|Z].
    { intros h Ih. apply In_seq in Ih. apply consistent_can_tell; auto. }
    { right. intros [_ [X'|[_ Z']]]; auto. }
    left. auto.
  - left. apply In_seq in Ie, Ih. eexists. eexists. eapply settles_loop; eauto. split; auto.
  - apply In_seq in Ie. destruct r as (a, b). apply arcs_links in Ir. simpl in S.
    assert (V := link_valid _ _ _ _ (link_sym _ _ _ _ Ir)).
    unfold valid in V. destruct (seen L (fst b)) as [(d, m)|] eqn:E; [|tauto].
    left. eexists. eexists. apply settles_new with (e := e) (p := b) (m := m).
    + split; auto.
    + exists a, b. split; auto. split; auto. constructor.
    + eauto.
    + intros h Hh C. apply N. exists h. rewrite In_seq. auto.
  - right. intros (M' & T' & St). apply N.
    destruct St as [M T e h [He Oe] Hh X|M T e p d m [He Oe] X E Ref]; exists e; rewrite In_seq;
      split; auto; split; auto.
    + left. exists h. rewrite In_seq. auto.
    + right. destruct X as (a & b & K & Sa & Sb). split.
      * exists (a, b). split; auto. apply arcs_links. auto.
      * intros (h & Ih & C). apply In_seq in Ih. apply (Ref h); auto.
Qed.

(** Nothing more follows. *)
Definition nothing_left L M T := forall M' T', ~ settles L M T M' T'.

(** What settling all does. *)
Lemma settles_all_grounded L M T M' T' : settles_all L M T M' T' -> possible nothing L ->
  grounded L M T ->
  grounded L M' T' /\ nothing_left L M' T' /\ darts M <= darts M' /\ (forall x, x < darts M ->
    T' x = T x) /\
  (forall e, alpha M' e = None -> e < darts M -> alpha M e = None) /\
  exists i, known M' = 2 * i + known M /\ (i = 0 -> M' = M /\ T' = T).
Proof.
  intros St Shown. induction St as [M T N|M T M1 T1 M' T' S1 _ IH]; intros G.
  - split; auto. split; auto. split; auto. split; auto. split; auto. exists 0. auto.
  - destruct (settles_grounded L M T Shown G M1 T1 S1) as (G1 & K1 & D1 & E1 & O1).
    destruct (IH G1) as (G' & Sat & D' & E' & O' & i & K' & _). split; auto. split; auto.
    split; [lia|]. split; [intros x Hx; rewrite E', E1; auto; lia|].
    split; [intros e Oe He; apply O1; auto; apply O'; auto; lia|].
    exists (S i). split; [lia|discriminate].
Qed.

(** A map embedded in a world is no larger. *)
Lemma grounded_le W L M T : world W -> replays W L -> grounded L M T ->
  darts M <= darts W /\ vertices M <= vertices W.
Proof.
  intros HW R G. assert (WW := world_is_map W HW). apply replays_visits in R as [v V]; auto.
  assert (E := g_embedded _ _ _ G W v HW V). split.
  - apply (pigeon (fun x => dart W v (T x))); apply E.
  - eapply embedded_vertices; eauto. apply G.
Qed.

(** All that follows can be settled. *)
Lemma settles_all_exists W L : world W -> replays W L -> forall M T, grounded L M T ->
  exists M' T', settles_all L M T M' T'.
Proof.
  intros HW R M T G. assert (Shown := replays_shown W L HW R).
  remember (darts W - known M) as n eqn:En. revert M T G En.
  induction n as [n IH] using lt_wf_ind. intros M T G ->.
  destruct (settles_can_tell L M T Shown G) as [(M1 & T1 & S1)|N].
  - destruct (settles_grounded L M T Shown G M1 T1 S1) as (G1 & K1 & _).
    assert (Le := proj1 (grounded_le W L M1 T1 HW R G1)).
    assert (Kn := count_le (explored M1) (darts M1)). fold (known M1) in Kn.
    destruct (IH (darts W - known M1)) with (M := M1) (T := T1) as (M' & T' & S'); auto; [lia|].
    exists M', T'. eapply settles_more; eauto.
  - exists M, T. apply settles_end. intros M' T' S1. eauto.
Qed.
