(** The rules and motions of the paper, each with its contract (docs/semantics.md, section 7; claim 3).

    rule       what the last sequence is compared with                                listing
    none       nothing                                                                1
    prefix     the map along the hypothesis' own way home, on the common doors        2
    history    the map, traced from the hypothesis                                    section III-B
    records    that, and one place (levels 1) or all (no limit) seen behind open darts    3

    M is the map, W the world, phi their correspondence, T a list of records; h is a hypothesis, own
    its way home; w are doors, ps percepts. The earlier sequences of the edge were compared when they
    were the last, with a map and records that have not changed since. *)
From Coq Require Import Arith Lia List Bool.
Import ListNotations.
From Topo Require Import World Rotation Embedding Augment Records Mapper.

(** The first hypothesis, walked from vu. *)
Definition retrace : Motion := fun _ K => match K with c :: _ => Some (c, 0) | [] => None end.

(** The number of doors that two lists share from the first on. *)
Fixpoint common (u v : list nat) := match u, v with
  | j :: u, k :: v => if j =? k then S (common u v) else 0 | _, _ => 0 end.

(** Enhancement I, stage 2: the hypothesis that shares most doors with those executed; the first of
    those that tie. *)
Fixpoint overlap (ds : list nat) (K : list hypothesis) : option (hypothesis * nat) := match K with
  | c :: K => let s := common (snd c) ds in
    match overlap ds K with
    | Some (g, t) => if s <? t then Some (g, t) else Some (c, s)
    | None => Some (c, s)
    end
  | [] => None
  end.

(** Motion retrace chooses a hypothesis. *)
Theorem retrace_good : good_motion retrace.
Proof. intros ds [|c K]; simpl; auto. repeat split; auto; lia. Qed.

(** The doors counted are there and are shared. *)
Lemma common_spec u : forall v, common u v <= length u /\ common u v <= length v /\
  firstn (common u v) u = firstn (common u v) v.
Proof.
  induction u as [|j u IH]; intros [|k v]; simpl; try (repeat split; auto; lia).
  destruct (Nat.eqb_spec j k) as [->|]; simpl; [|repeat split; auto; lia].
  destruct (IH v) as (A & B & C). rewrite C. repeat split; auto; lia.
Qed.

(** Motion overlap chooses a hypothesis, and the doors that it takes for shared are.
    Paper, III-A: Stage 2: the robot stays, takes the longest overlap, and walks only what is not
    shared. *)
Theorem overlap_good : good_motion overlap.
Proof.
  intros ds K. induction K as [|c K IH]; simpl; auto. destruct (common_spec (snd c) ds) as (A & B & C).
  destruct (overlap ds K) as [(g, t)|]; [|auto].
  destruct (_ <? t); [|auto]. destruct IH as (I & IH). auto.
Qed.

(** A rule that remembers nothing of earlier edges and keeps what [compare] does not contradict:
    the last sequence is put to it. *)
Definition forgetful (compare : Map -> hypothesis -> sequence -> bool) : Rule :=
  {| memory := unit; fresh := tt; learn := fun _ _ _ _ _ _ => tt;
     keep := fun M _ _ _ log _ c => match log with s :: _ => compare M c s | [] => true end;
     concludes := fun _ _ _ _ _ _ _ => false |}.

(** Rule none: only motion rejects. *)
Definition rule_none := forgetful (fun _ _ _ => true).

(** Compare percepts with those of the map along the doors own, as long as the doors w are these. *)
Fixpoint agrees_on_way M h own w ps : bool := match own, w, ps with
  | j :: own, k :: w, p :: ps => if j =? k
    then match move M h j with
         | Some x => percept_eqb (percept M x) p && agrees_on_way M x own w ps
         | None => true end
    else true
  | _, _, _ => true
  end.

(** Enhancement I, stage 1: rule prefix. *)
Definition rule_prefix :=
  forgetful (fun M c s => agrees_on_way M (fst c) (snd c) (fst s) (snd s)).

(** Enhancement II: rule history. *)
Definition rule_history := forgetful (fun M c s => agrees M (fun _ _ => None) (fst c) (fst s) (snd s)).

(** Rule prefix rejects no more than rules history and records: what agrees with the whole map agrees
    on the common doors.
    Paper, III-B: It incorporates stage 1 of Enhancement I. *)
Theorem prefix_weaker M T own : forall h w ps,
  agrees M T h w ps = true -> agrees_on_way M h own w ps = true.
Proof.
  induction own as [|j own IH]; intros h [|k w] [|p ps]; simpl; auto.
  destruct (Nat.eqb_spec j k) as [->|]; auto. unfold move.
  destruct (k <? degree M h); simpl; [|discriminate].
  destruct (alpha M (turn M k h)) as [x|]; auto.
  destruct (percept_eqb (percept M x) p); simpl; [auto|discriminate].
Qed.

(** A forgetful rule fulfils its contract if it never contradicts what the world shows. *)
Lemma forgetful_good compare : (forall M W phi h w u ps, world W -> is_map M -> embedded M W phi ->
    h < darts M -> percepts W (phi h) u = Some ps -> compare M (h, w) (u, ps) = true) ->
  good_rule (forgetful compare) (fun _ _ _ _ _ => True).
Proof.
  intros H. split; auto; [|simpl; discriminate].
  intros M W phi T e [|(u, ps) log] s t b h w r HW WM E _ _ _ _ _ Lh _ _ Hl; simpl; auto.
  apply (H M W phi); auto. apply (Hl (u, ps)). left. auto.
Qed.

(** Claim 3 for rule none. *)
Theorem rule_none_good : good_rule rule_none (fun _ _ _ _ _ => True).
Proof. apply forgetful_good. auto. Qed.

(** Claim 3 for rule history: it rejects only false hypotheses.
    Paper, III-B: Every sequence executed for e is traced on S from the hypothesis; a mismatch
    rejects it. *)
Theorem rule_history_good : good_rule rule_history (fun _ _ _ _ _ => True).
Proof.
  apply forgetful_good. intros M W phi h w u ps HW WM E Lh Hp.
  apply (agrees_true M W phi); auto; [apply HW|red; discriminate].
Qed.

(** Claim 3 for rule prefix: it rejects only false hypotheses.
    Paper, III-A: Stage 1: what was seen on shared first doors rejects other hypotheses without
    motion. *)
Theorem rule_prefix_good : good_rule rule_prefix (fun _ _ _ _ _ => True).
Proof.
  apply forgetful_good. intros M W phi h w u ps HW WM E Lh Hp.
  apply prefix_weaker with (fun _ _ => None).
  apply (agrees_true M W phi); auto; [apply HW|red; discriminate].
Qed.

(** A record: an open dart, doors behind it, and the percept seen there. *)
Definition record_of : Type := nat * list nat * Percept.

(** Are two lists of doors the same? *)
Fixpoint doors_eqb (u v : list nat) := match u, v with
  | [], [] => true | j :: u, k :: v => (j =? k) && doors_eqb u v | _, _ => false end.

(** Equal lists of doors are equal. *)
Lemma doors_eqb_true u : forall v, doors_eqb u v = true -> u = v.
Proof.
  induction u as [|j u IH]; intros [|k v]; simpl; try discriminate; auto.
  destruct (Nat.eqb_spec j k) as [->|]; simpl; [|discriminate]. intros H. f_equal. auto.
Qed.

(** The list as a table: what was seen behind dart d after the doors w. *)
Definition recorded (T : list record_of) : table := fun d w =>
  match find (fun r => (fst (fst r) =? d) && doors_eqb (snd (fst r)) w) T with
  | Some r => Some (snd r) | None => None end.

(** The places behind a dart, by their doors: after u the first of ps was seen, after u and each
    further door of w the next. *)
Fixpoint behind_doors u w (ps : list Percept) : list (list nat * Percept) := match ps with
  | p :: ps => (u, p) :: match w with k :: w => behind_doors (u ++ [k]) w ps | [] => [] end
  | [] => []
  end.

(** The first ones, if there is a limit. *)
Definition at_most {A} (levels : option nat) (l : list A) :=
  match levels with Some n => firstn n l | None => l end.

(** What a sequence that was traced from dart x shows behind the first open dart that it crosses. *)
Fixpoint noted levels M x w ps : list record_of := match w, ps with
  | k :: w, p :: ps' => match alpha M (turn M k x) with
    | Some y => noted levels M y w ps'
    | None => map (fun r => (turn M k x, fst r, snd r)) (at_most levels (behind_doors [] w ps))
    end
  | _, _ => []
  end.

(** Add a record, unless the place is recorded. *)
Definition add_record (r : record_of) T :=
  match recorded T (fst (fst r)) (snd (fst r)) with Some _ => T | None => r :: T end.

(** Enhancement III: rule records. One-level: the limit is 1; all-level: there is none. When e and h
    have become partners their records are dropped, and each sequence is traced from h. *)
Definition rule_records (levels : option nat) : Rule :=
  {| memory := list record_of; fresh := [];
     keep := fun M _ _ T log _ c => match log with
       s :: _ => agrees M (recorded T) (fst c) (fst s) (snd s) | [] => true end;
     concludes := fun _ _ _ _ _ _ _ => false;
     learn := fun M e h T log _ =>
       fold_right (fun s T => fold_right add_record T (noted levels M h (fst s) (snd s)))
         (filter (fun r => negb (fst (fst r) =? e) && negb (fst (fst r) =? h)) T) log |}.

(** Each record says what the world shows behind its dart. *)
Definition true_records M W (phi : nat -> nat) (T : list record_of) := forall d w q, In (d, w, q) T ->
  d < darts M /\ exists b c, alpha W (phi d) = Some b /\ walk W b w = Some c /\ percept W c = q.

(** True records are a true table. *)
Lemma recorded_true M W phi T : true_records M W phi T -> true_table M W phi (recorded T).
Proof.
  intros H d w q _ Q. unfold recorded in Q. match type of Q with
    context [find ?f T] => destruct (find f T) as [((d', w'), q')|] eqn:F; [|discriminate] end.
  injection Q as <-. apply find_some in F as [I B]. simpl in B.
  apply andb_true_iff in B as [B1 B2]. apply Nat.eqb_eq in B1. apply doors_eqb_true in B2. subst.
  apply (H d w q') in I. apply I.
Qed.

(** The places behind a dart are as the world shows them. *)
Lemma behind_doors_true W b : forall w u c ps v q, walk W b u = Some c -> percepts W c w = Some ps ->
  In (v, q) (behind_doors u w (percept W c :: ps)) -> exists d, walk W b v = Some d /\ percept W d = q.
Proof.
  intros w. induction w as [|k w IH]; intros u c ps v q Hu Hw I; cbn [behind_doors] in I;
    destruct I as [I|I]; try (injection I as <- <-; eauto); [destruct I|].
  simpl in Hw. destruct (move W c k) as [c'|] eqn:Em; [|discriminate].
  destruct (percepts W c' w) as [qs|] eqn:Q; [|discriminate]. injection Hw as <-.
  apply (IH (u ++ [k]) c' qs v q); auto. rewrite walk_app, Hu. simpl. rewrite Em. auto.
Qed.

(** What a sequence is noted to show is true. *)
Lemma noted_true levels M W phi (WM : is_map M) (WW : is_map W) (E : embedded M W phi) w :
  forall x ps, x < darts M -> percepts W (phi x) w = Some ps ->
  true_records M W phi (noted levels M x w ps).
Proof.
  induction w as [|k w IH]; simpl; intros x ps Hx Hw d v q I; [destruct I|].
  destruct (move W (phi x) k) as [b|] eqn:Em; [|discriminate].
  destruct (percepts W b w) as [qs|] eqn:Q; [|discriminate]. injection Hw as <-.
  assert (L : turn M k x < darts M) by (apply turn_lt; auto).
  unfold move in Em. destruct (k <? degree W (phi x)); [|discriminate].
  rewrite <- (embedded_turn M W phi) in Em by auto.
  destruct (alpha M (turn M k x)) as [y|] eqn:Ey.
  - assert (Ly : y < darts M) by (eapply alpha_ok; eauto).
    apply (phi_alpha _ _ _ E) in Ey; auto. apply (IH y qs); auto. congruence.
  - apply in_map_iff in I as ((v', q') & Eq & I). injection Eq as <- <- <-. split; auto.
    assert (I' : In (v', q') (behind_doors [] w (percept W b :: qs))).
    { unfold at_most in I. destruct levels as [n|]; auto.
      rewrite <- (firstn_skipn n (behind_doors _ _ _)). apply in_or_app. auto. }
    destruct (behind_doors_true W b w [] b qs v' q' eq_refl Q I') as (c & C1 & C2). eauto.
Qed.

(** Adding true records to true records. *)
Lemma add_records_true M W phi T l : true_records M W phi T -> true_records M W phi l ->
  true_records M W phi (fold_right add_record T l).
Proof.
  intros HT. induction l as [|r l IH]; simpl; auto. intros Hl d w q I. unfold add_record in I at 1.
  destruct (recorded _ _ _).
  - apply IH; auto. intros d' w' q' I'. apply Hl. right. auto.
  - destruct I as [->|I]; [apply Hl; left; auto|]. apply IH; auto.
    intros d' w' q' I'. apply Hl. right. auto.
Qed.

(** Claim 3 for rule records, one-level and all-level: the records are true, and true records reject
    only false hypotheses.
    Paper, III-C: After e is validated, what was seen behind unexplored edges is recorded. *)
Theorem rule_records_good levels :
  good_rule (rule_records levels) (fun M W phi _ => true_records M W phi).
Proof.
  assert (Learned : forall M W phi e h (T : list record_of) log u, is_map M -> is_map W ->
    embedded M W phi -> true_records M W phi T -> h < darts M ->
    (forall s, In s log -> percepts W (phi h) (fst s) = Some (snd s)) ->
    true_records M W phi (learn (rule_records levels) M e h T log u)).
  { intros M W phi e h T log u WM WW E HT Lh. simpl. induction log as [|s log IH]; simpl; intros Hl.
    - intros d w q I. apply filter_In in I as [I _]. apply HT; auto.
    - apply add_records_true; [apply IH; auto|]. apply noted_true; auto. }
  split.
  - intros W phi d HW WM E d' w q [].
  - intros M W phi T e [|s log] o t b h w r HW WM E HT _ _ _ _ Lh _ _ Hl; simpl; auto.
    apply (agrees_true M W phi); auto; [apply HW|apply recorded_true; auto|]. apply Hl. left. auto.
  - simpl. discriminate.
  - intros M W phi T e h log s u t HW WM E HT _ _ _ Le Lh Oe Oh E' WM' Hl. apply Learned; auto. apply HW.
  - intros M W phi T e a log s u t HW WM E HT _ _ _ Le Oe Ha N psi E' WM' Hl.
    assert (WW := world_is_map W HW).
    assert (La : a < darts W) by (apply (alpha_ok W WW) in Ha; [apply Ha|apply (phi_lt _ _ _ E); auto]).
    destruct (degree_spec W WW a La) as (D & _). apply Learned; auto.
    + intros d w q I. destruct (HT d w q I) as (Ld & H). split; [unfold N; simpl; lia|].
      unfold psi, extend. rewrite (proj2 (Nat.ltb_lt _ _) Ld). auto.
    + unfold N. simpl. lia.
    + unfold psi, extend. rewrite Nat.ltb_irrefl, Nat.sub_diag. auto.
Qed.
