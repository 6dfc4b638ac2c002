"""The tests that take long: `make long` and `make nightly` run them, `make test` does not.

A test is named here if it takes more than about one second: the largest sizes of statements whose
smaller sizes `make test` runs, and whole commands whose parts it runs one by one. `.ci/run` runs
all of them, so that a change is asked everything before it is taken.
"""

import re
from pathlib import Path

LONG: dict[str, tuple[str, ...]] = {
    "algorithms/test_folding.py": ("test_what_is_kept_has_a_witness_in_larger_worlds",),
    "algorithms/test_large.py": (r"test_a_path_of_5000_vertices_is_walked_once\[.*\]",),
    "algorithms/test_planar.py": (
        r"test_every_claim_of_those_that_steer_holds_in_planar_worlds\[.*\]",
    ),
    "algorithms/test_policies.py": (
        r"test_every_pair_of_policies_keeps_all_claims_on_every_world_with_3_edges\[.*\]",
    ),
    "algorithms/test_steering.py": (r"test_every_claim_holds_in_worlds_drawn\[.*\]",),
    "checkers/test_consequences.py": ("test_what_is_met_is_what_follows_in_any_order",),
    "checkers/test_entailment.py": (r"test_where_a_guess_is_lucky_its_witness_breaks_it\[.*\]",),
    "checkers/test_faulty_mappers.py": (
        r"test_without_a_directed_marker_there_are_false_confirmations\[.*\]",
    ),
    "checkers/test_lies.py": (
        "test_a_doctored_trace_gets_the_same_verdict_from_a_second_opinion",
        "test_nonsense_is_judged_and_never_crashes",
    ),
    "checkers/test_witnesses.py": (
        "test_a_dart_is_rejected_by_planarity_just_if_the_edge_would_raise_the_genus_of_s",
    ),
    "cli/test_arena.py": (
        "test_a_league_that_is_killed_goes_on_where_it_was",
        "test_a_mapper_that_has_changed_is_refused",
        r"test_an_entrant_that_fails_between_two_messages_ends_no_league\[denies-.*\]",
        "test_the_same_bytes_however_many_workers_and_however_often_interrupted",
    ),
    "cli/test_compare.py": (
        "test_a_cheaper_mapper_passes_and_a_dearer_one_does_not",
        "test_a_time_out_is_incomplete",
        "test_a_wrong_mapper_exits_1_and_the_line_shows_it_again",
        "test_an_algorithm_has_the_policies_of_the_baseline_unless_others_are_asked_for",
        "test_nothing_has_changed_for_the_same_mapper",
        "test_only_what_has_changed_has_a_row",
        "test_the_page_shows_what_is_printed",
        "test_two_comparisons_are_equal_but_for_the_time",
    ),
    "cli/test_completion.py": ("test_bash_offers_commands_options_and_values",),
    "cli/test_conform.py": (
        "test_a_program_meets_the_worlds_in_an_order_that_is_drawn_anew",
        "test_an_entry_a_level_with_every_promised_field",
        "test_two_runs_differ_in_timing_alone",
    ),
    "cli/test_coverage_shown.py": ("test_a_search_and_a_report_over_many_worlds_say_so_as_well",),
    "cli/test_engine.py": ("test_a_local_cluster_gives_the_entry_of_workers_here",),
    "cli/test_exits.py": (
        "test_a_full_disk_is_told_as_such",
        "test_a_reader_who_leaves_early_ends_the_work",
        r"test_a_reader_who_leaves_is_no_error\[explore nyc\]",
        "test_a_terminal_without_our_letters_gets_others",
        "test_closed_streams_do_not_hurt",
        "test_ctrl_c_after_a_finding_exits_1",
        r"test_ctrl_c_and_sigterm_exit_3_and_print_what_is_done\[.*\]",
        "test_ctrl_c_in_explore_keeps_the_runs_that_are_done",
        r"test_exit_1_is_for_counterexamples_and_not_for_broken_streams\[.*\]",
        "test_sigterm_says_where_it_stopped_and_keeps_what_is_done",
        r"test_two_runs_differ_in_timing_alone\[.*\]",
        r"test_two_runs_differ_in_timing_alone\[verify .*\]",
        "test_what_a_mapper_prints_goes_to_stderr",
    ),
    "cli/test_explore.py": (
        r"test_a_faulty_mapper_is_found_and_its_line_shows_it_again\[.*\]",
        "test_a_large_world_from_stdin_is_kept_in_a_file_for_the_line",
        "test_a_mapper_that_moves_on_when_time_is_up_is_not_decided",
        "test_one_world_gets_a_table_of_algorithms",
        "test_tables_fit_into_80_columns_without_colour",
        "test_without_algorithm_the_whole_catalogue_is_run",
    ),
    "cli/test_faults.py": ("test_a_fault_that_no_check_was_put_to_is_not_counted_as_caught",),
    "cli/test_in_process.py": (
        r"test_what_a_mapper_prints_stands_marked_on_standard_error\[.*\]",
        "test_workers_run_no_code_from_the_current_folder",
    ),
    "cli/test_outcomes.py": (
        r"test_every_form_of_a_killed_mapper_agrees\[.*\]",
        r"test_every_form_of_a_resumed_run_agrees\[arena .*\]",
        r"test_every_form_of_an_outcome_agrees\[(arena|verify)-.\]",
    ),
    "cli/test_programs.py": (
        "test_a_changed_program_does_not_go_on_with_a_ledger",
        "test_a_wrong_program_has_its_smallest_counterexample_which_replay_shows",
        r"test_search_goes_through_all_worlds_with_a_program\[.*\]",
        "test_verify_and_explore_run_programs",
    ),
    "cli/test_prove.py": ("test_two_runs_are_byte_equal_without_the_timing",),
    "cli/test_record.py": (
        "test_a_mapper_that_hangs_has_no_baseline",
        "test_the_default_corpus_is_recorded",
    ),
    "cli/test_replay.py": ("test_the_trace_of_a_large_world_needs_the_world",),
    "cli/test_reporting.py": (
        r"test_each_command_gives_an_account_in_three_forms\[(faults|conform|compare|prove) .*\]",
        r"test_fifty_columns_break_no_number_and_no_verdict\[(faults|prove|search|verify) .*\]",
        "test_two_runs_have_one_page_but_for_the_timing",
        "test_what_is_printed_is_the_same_with_a_report_and_without",
        "test_verify_has_a_suite_a_part_and_a_case_a_claim",
    ),
    "cli/test_reproduce.py": (
        "test_the_same_bytes_however_many_workers_and_however_often_interrupted",
    ),
    "cli/test_search.py": (
        r"test_a_counterexample_exits_1_and_is_the_same_with_any_workers\[.*\]",
        "test_a_ledger_is_resumed",
        "test_a_mapper_out_of_time_exits_3",
        "test_claims_without_declarations_are_named",
        "test_compare_shows_where_the_first_costs_more",
        r"test_ctrl_c_exits_3_and_prints_what_is_done\[.*\]",
        "test_json_is_equal_byte_for_byte_but_for_timing",
        "test_keeping_going_shows_the_smallest_world_of_each_claim",
    ),
    "cli/test_targets.py": (r"test_an_argument_and_the_option_are_the_same\[verify\]",),
    "cli/test_tidiness.py": (r"test_worlds_are_drawn_and_hypothesis_leaves_no_folder\[.*\]",),
    "cli/test_verify.py": (
        r"test_the_word_verified_is_never_printed\[basic-pretty\]",
        r"test_a_faulty_mapper_is_refuted_and_the_line_shows_it_again\[ignores_direction-m1/1\]",
        r"test_a_faulty_mapper_is_refuted_and_the_line_shows_it_again\[loops .*\]",
        r"test_a_faulty_mapper_is_refuted_and_the_line_shows_it_again\[walks --budget 500-m1/0\]",
        "test_a_refuted_part_shows_its_smallest_counterexample",
        "test_a_silent_mapper_passes_with_four_claims_not_declared",
        "test_each_part_has_its_own_line",
        "test_markdown_is_a_report_with_valid_tables",
        "test_quick_checks_the_catalogue_in_six_parts",
        "test_time_outs_leave_a_part_undecided",
        "test_what_does_not_concern_a_mapper_of_ones_own_is_left_out_and_said",
    ),
    "compiled/test_kernel.py": (
        r"test_a_full_disk_is_an_error_that_names_the_folder_and_leaves_nothing\[.*\]",
        r"test_damaged_machine_code_is_compiled_again_with_a_warning\[(?!flip_code|copy_code).*\]",
    ),
    # These wait for layouts that no other test has compiled.
    "compiled/test_faults.py": (
        "test_a_mistake_is_seen_as_a_difference_from_the_reference",
        r"test_equal_events_in_every_world_to_3_edges\[.*\]",
        r"test_equal_events_in_some_worlds_in_which_the_mistake_shows\[.*\]",
        r"test_a_wrong_mapper_writes_nothing_beyond_a_field\[.*\]",
    ),
    "compiled/test_explore.py": (
        "test_a_run_that_fills_the_small_layout_is_made_in_the_large_one",
        "test_a_trace_grows_until_it_holds_the_run",
    ),
    "compiled/test_judging.py": (
        "test_every_claim_has_a_mistake_and_the_judge_as_it_is_has_none",
        r"test_every_run_to_3_edges_has_the_verdict_of_the_checkers\[.*-.*-.*\]",
        r"test_machine_code_gives_each_run_the_verdict_of_the_checkers\[does-not-fit-.*\]",
        r"test_sampled_runs_with_4_edges_have_the_verdict_of_the_checkers\[.*\]",
    ),
    "compiled/test_same_events.py": (
        r"test_equal_events_in_a_real_network\[.*\]",
        r"test_equal_events_in_uniform_worlds_of_7_to_12_edges\[.*\]",
        r"test_equal_events_in_worlds_beyond_the_small_layout\[.*\]",
    ),
    "compiled/test_shard.py": (
        "test_a_range_stops_behind_its_first_failing_world",
        "test_a_run_of_more_words_than_the_workspace_has_is_judged_by_the_checkers",
        r"test_a_seeded_fault_has_the_verdicts_that_the_checkers_give\[.*\]",
    ),
    "docs/test_pages.py": (r"test_what_a_page_says_can_be_done_and_prints_what_it_shows\[.*\]",),
    "docs/test_site.py": (r"test_a_player_that_shows_nothing_ends_the_build\[.*\]",),
    "examples/test_every_example.py": ("test_the_pytest_file_beside_the_python_mapper_passes",),
    "examples/test_first_look.py": (
        "test_a_run_is_a_page_in_a_frame",
        "test_the_catalogue_holds_what_is_claimed",
        "test_the_hunt_ends_in_the_world_of_docs_search",
        "test_the_mapper_is_right_by_luck_and_its_witness_tells",
        "test_worlds_are_pictures",
    ),
    "examples/test_property_test.py": (
        r"test_it_fails_with_the_world_that_the_page_says\[, simple=True-m3/13\]",
        r"test_it_fails_with_the_world_that_the_page_says\[.*\]",
    ),
    "examples/test_pytest_plugin.py": (
        "test_a_wrong_one_fails_with_the_world",
        "test_the_mapper_passes_its_tests",
        "test_the_steps_of_the_workflow_work",
    ),
    "studies/game/test_rules.py": (
        r"test_no_bound_is_above_the_value\[3\]",
        r"test_the_bounds_change_no_value_of_three_edges\[.*\]",
    ),
    "campaign/test_cluster.py": (
        "test_a_client_that_is_killed_resumes_from_its_store",
        "test_a_cluster_whose_workers_are_all_lost_ends_the_search_with_a_sentence",
        "test_a_lost_scheduler_ends_the_search_with_a_sentence",
        "test_a_lost_worker_changes_nothing",
        "test_a_mapper_that_is_not_there_is_refused",
        "test_a_mapper_that_lacks_memory_on_a_worker_alone_is_undecided",
        "test_a_program_runs_on_the_cluster",
        "test_a_scheduler_without_workers_is_told",
        "test_a_worker_that_finds_another_helper_module_is_refused",
        "test_a_worker_with_another_helper_that_it_loads_late_is_refused",
        r"test_a_worker_with_another_topo_verify_is_refused\[.*\]",
        "test_a_worker_with_another_mapper_is_refused",
        "test_a_world_that_takes_every_worker_with_it_is_undecided_and_convicts_nobody",
        r"test_results_are_equal_byte_for_byte_to_those_of_workers_here\[.*\]",
    ),
    "campaign/test_cluster_engine.py": (
        "test_a_worker_that_is_killed_changes_no_total",
        "test_a_worker_without_numba_is_named_with_the_mend",
        r"test_results_are_equal_byte_for_byte_to_those_of_workers_here\[.*\]",
    ),
    "campaign/test_run_engines.py": (
        r"test_a_seeded_fault_is_found_in_the_same_worlds_by_either_engine\[.*\]",
        "test_both_engines_record_the_same_baseline",
        "test_workers_use_the_engine_that_is_asked_for",
    ),
    "campaign/test_compiled.py": (
        "test_slices_and_workers_change_nothing",
        r"test_the_compiled_engine_counts_what_the_checkers_count\[.*\]",
        "test_verify_goes_one_size_further_and_compares_the_engines",
    ),
    "studies/baseline/test_compare.py": (
        "test_classes_of_the_extremes_have_names",
        "test_the_worlds_are_those_of_the_file",
    ),
    "studies/conform/test_batch.py": (
        r"test_what_goes_wrong_in_one_world_is_found_there_alone\[.*\]",
        r"test_what_goes_wrong_in_one_world_is_found_there_alone\[hangs-.*\]",
    ),
    "studies/conform/test_conform.py": (
        "test_after_many_time_outs_the_rest_is_not_tried",
        r"test_the_examples_decide_as_the_reference_event_for_event\[(c|js)\]",
        r"test_the_examples_decide_as_the_reference_event_for_event\[.*\]",
        r"test_the_number_of_workers_changes_nothing\[.*\]",
        r"test_the_number_of_workers_changes_nothing\[3\]",
        r"test_the_wrong_examples_are_found_out\[.*\]",
    ),
    "studies/conform/test_misbehaviour.py": (
        r"test_misbehaviour_is_one_finding_for_its_world\[closes its input\]",
        r"test_misbehaviour_is_one_finding_for_its_world\[delivers and reads no more\]",
        r"test_misbehaviour_is_one_finding_for_its_world\[floods declarations of 1 MB\]",
        r"test_misbehaviour_is_one_finding_for_its_world\[floods declarations\]",
        r"test_misbehaviour_is_one_finding_for_its_world\[floods stderr\]",
        r"test_misbehaviour_is_one_finding_for_its_world\[hangs\]",
        r"test_misbehaviour_is_one_finding_for_its_world\[ignores SIGTERM\]",
        r"test_misbehaviour_is_one_finding_for_its_world\[prints half a line and hangs\]",
    ),
    "studies/test_faults.py": (
        r"test_a_harmless_difference_is_not_flagged\[(?!reports-no-cost).*\]",
        "test_workers_find_the_same_in_the_same_order",
    ),
    "studies/search/states/test_graph.py": (
        "test_a_fault_that_only_some_policies_show_is_found_with_the_fewest_choices",
        r"test_the_numbers_of_states_and_of_choices_are_pinned\[.*-3-.*\]",
        r"test_the_states_have_the_costs_and_verdicts_of_all_runs_one_by_one\[.*\]",
        r"test_the_states_have_the_costs_of_all_runs_in_worlds_of_three_edges\[.*\]",
    ),
    "studies/search/states/test_kernel.py": (
        r"test_it_does_so_where_rules_and_motions_differ\[.*\]",
        r"test_it_finds_the_states_the_choices_and_the_costs_that_the_mapper_has\[3-.*\]",
    ),
    "studies/search/states/test_planted.py": (
        "test_a_mistake_that_rests_on_the_numbers_of_darts_is_found_in_four_edges",
        r"test_a_mistake_in_the_code_that_is_shipped_is_found\[m4/.*\]",
    ),
    "studies/search/test_again.py": (
        r"test_a_mapper_that_does_the_same_each_time_is_judged_as_before\[.*\]",
        r"test_a_mapper_that_draws_lots_leaves_the_verdict_open\[.*\]",
        "test_a_mapper_that_is_right_alone_and_in_the_order_of_the_search_is_tried_in_another",
        "test_a_program_is_run_again_too",
        "test_a_world_that_fails_after_others_only_is_shown_after_others",
        "test_where_no_row_of_worlds_makes_it_fail_the_search_is_named",
    ),
    "studies/search/test_choices.py": (
        "test_a_finding_names_the_fewest_choices_and_the_run_that_shows_it_again",
    ),
    "studies/search/test_page.py": (r"test_a_command_prints_what_the_page_shows\[.*\]",),
    "studies/search/test_search.py": (
        r"test_a_program_that_is_killed_once_is_tried_again\[.*\]",
        r"test_a_class_is_exhausted_when_its_number_is_met\[.*\]",
        r"test_the_size_of_the_shards_makes_no_difference\[.*-(1|10000)\]",
        "test_the_planar_prior_is_right_in_planar_worlds_and_wrong_in_all_others",
        "test_two_mappers_in_the_same_worlds_are_compared",
    ),
    "studies/test_map_check.py": (
        r"test_the_way_on_proves_the_map_behind_every_log\[3\]",
        "test_the_way_on_proves_larger_maps_behind_any_log",
    ),
    "studies/reproduce/test_points_runs.py": ("test_workers_make_the_same_rows",),
    "studies/reproduce/test_points.py": (
        r"test_the_points_in_docs_are_those_that_this_code_makes\[6.\]",
    ),
    "studies/test_gap.py": ("test_the_basic_algorithm_has_the_largest",),
    "campaign/test_store.py": ("test_killed_at_random_moments_it_ends_with_the_same_totals",),
    "campaign/test_pool.py": (
        r"test_a_machine_that_is_frozen_for_longer_than_a_limit_convicts_no_mapper\[.*\]",
        "test_a_mapper_that_cannot_be_interrupted_is_given_up",
        "test_a_mapper_that_loops_ends_at_its_time_limit",
        "test_a_shard_that_strangers_kill_again_and_again_is_cut_down_to_worlds_and_done",
        "test_a_shard_whose_worker_was_killed_is_not_kept_in_a_store",
        r"test_a_world_that_kills_its_worker_twice_is_a_finding\[.*\]",
        "test_all_worlds_that_kill_their_workers_are_found",
        r"test_results_are_equal_byte_for_byte_however_many_work\[.*\]",
        r"test_results_are_equal_byte_for_byte_however_many_work\[enhancement.*\]",
        "test_the_item_that_hangs_is_found",
    ),
    "campaign/test_worker.py": (
        r"test_a_mapper_that_tries_from_its_first_line_on_gets_hold_of_no_worker\[.*\]",
    ),
    "studies/verify/test_proofs.py": (
        "test_all_that_is_quick_comes_out_as_it_must",
        "test_quick_is_the_inductive_theorems_alone",
    ),
    "studies/verify/test_verify.py": (
        "test_progress_is_told_part_by_part",
        "test_the_whole_campaign_exhausts_what_it_says",
    ),
    "player/test_fold_js.py": ("test_it_shows_that_on_every_golden_trace",),
    "player/test_animation.py": (
        "test_on_a_torus_the_robot_leaves_on_one_side_and_comes_back_on_the_other",
    ),
    "player/test_model.py": (
        r"test_the_page_and_the_checkers_agree_on_every_algorithm\[(lattice|m4/41|m5/17)\]",
        r"test_the_page_and_the_checkers_agree_on_wrong_mappers\[.*\]",
    ),
    "player/test_player.py": (
        "test_in_a_frame_that_is_hidden_at_first_it_waits_for_its_room",
        "test_a_notebook_s_frame_plays_on_its_own",
        "test_both_panes_pan_and_zoom_together",
        "test_decisions_are_found_from_either_side",
        "test_every_control_has_a_name_and_a_place_in_the_order_of_focus",
        "test_help_names_the_signs_and_closes",
        "test_play_pauses_on_demand_and_runs_to_the_end",
        "test_slider_and_chart_lead_to_a_step",
        "test_two_mappers_go_in_step_by_cost_or_by_edge",
    ),
    "player/test_walk_mode.py": (
        "test_a_world_is_built_corner_by_corner_and_walked",
        "test_a_world_without_a_road_is_proved_by_looking",
        "test_a_wrong_declaration_is_shown_where_it_is_wrong",
        r"test_it_fits\[.*\]",
        "test_it_may_be_said_at_once_and_taken_back",
        "test_no_key_reaches_the_player_and_escape_leads_back",
        "test_the_reader_sees_percepts_only",
        "test_who_guesses_right_is_told_that_it_was_luck",
        "test_worlds_of_the_gallery_and_worlds_drawn_by_lot_can_be_walked",
    ),
    "programs/test_program.py": (
        r"test_a_seeded_fault_is_found_through_the_pipe_just_as_in_process\[(?!leaves-h-in-u).*\]",
    ),
    "programs/test_protocol.py": ("test_every_line_of_a_conversation_meets_its_schema",),
    "proofs/bounded/test_encoding.py": (
        r"test_percepts_are_alike_as_far_as_the_marker_is_looked_at\[.*\]",
        r"test_the_maps_are_exactly_those_that_an_exploration_can_draw\[3\]",
    ),
    "proofs/bounded/test_theorems.py": (
        "test_each_question_is_a_script_of_its_own",
        r"test_one_door_theorems_hold_in_all_worlds_up_to_four_edges\[bounded-confirm-final\]",
        r"test_one_door_theorems_hold_in_all_worlds_up_to_four_edges\[bounded-door\]",
        r"test_one_door_theorems_hold_in_all_worlds_up_to_four_edges\[bounded-pose\]",
        r"test_the_models_are_exactly_the_canonical_codes\[4-706\]",
        r"test_whole_words_hold_in_all_worlds_up_to_three_edges\[words-records-.*\]",
    ),
    "proofs/first_order/test_conformance.py": (
        r"test_a_change_inside_an_algorithm_is_seen\[basic.*\]",
        r"test_every_decision_in_every_world_to_four_edges\[.*\]",
        r"test_every_decision_in_every_world_to_four_edges\[enhancement-iii-.*\]",
    ),
    "proofs/first_order/test_folds_in_worlds.py": (
        "test_a_world_fits_its_own_walk_and_folds_identify_only_what_is_one_dart",
    ),
    "proofs/first_order/test_rule_mutants.py": (
        "test_a_stage_draws_the_map_of_the_scene",
        r"test_it_is_refuted_in_a_world_and_replayed\[conclude-the-last\]",
        r"test_it_is_refuted_in_a_world_and_replayed\[records-stale-root\]",
    ),
    "proofs/first_order/test_terms.py": ("test_evaluation_and_solver_agree",),
    "proofs/first_order/test_terms_in_worlds.py": (
        "test_every_axiom_holds_on_every_map_of_a_world",
        "test_the_obligations_hold_of_any_places_and_doors",
        "test_what_inductions_over_words_say_holds_of_any_word",
    ),
    "proofs/first_order/test_theorems.py": (
        r"test_its_mutant_is_refuted_by_a_structure\[records-written-without-trace\]",
    ),
    "proofs/mechanised/test_extracted_mappers.py": (
        r"test_both_take_the_same_doors_in_every_world_to_5_edges\[.*\]",
        r"test_both_take_the_same_doors_in_large_worlds\[.*\]",
    ),
    "proofs/solvers/test_cvc5_solver.py": (
        r"test_it_agrees_on_the_bounded_theorems\[words-records-all\]",
        r"test_it_agrees_on_the_bounded_theorems\[words-records-one\]",
        r"test_it_finds_the_counterexamples_too\[undirected-simple\]",
    ),
    "proofs/test_catalogue.py": (
        "test_each_question_is_a_whole_script_and_says_what_is_expected",
        "test_the_package_alone_loads_no_solver",
    ),
    "properties/test_claims.py": (
        r"test_every_claim_of_every_algorithm_holds_in_the_worlds_of_every_strategy\[.*\]",
        r"test_every_claim_of_what_assumes_a_plane_holds_in_planar_worlds\[.*\]",
        r"test_what_a_run_says_of_all_worlds_is_true_of_those_of_about_its_size\[.*\]",
    ),
    "properties/test_findings.py": (r"test_a_stronger_algorithm_may_cost_more\[.*-m5/177-.*\]",),
    "properties/test_rules.py": (
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[dense_worlds-history-records.1.\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[dense_worlds-none-prefix\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[dense_worlds-prefix-history\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[dense_worlds-records..u221e.-folding\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[nonplanar_worlds-history-records.1.\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[nonplanar_worlds-none-prefix\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[nonplanar_worlds-prefix-history\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[nonplanar_worlds-records..u221e.-folding\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[nonplanar_worlds-records.1.-records..u22.*\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[symmetric_worlds-none-prefix\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[symmetric_worlds-prefix-history\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[tree_worlds-history-records.1.\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[tree_worlds-none-prefix\]",
        r"test_a_stronger_rule_never_rejects_less_at_the_same_state\[tree_worlds-prefix-history\]",
    ),
    "properties/test_stateful.py": ("test_whatever_is_explored_in_whatever_order_s_stays_true",),
    "report/test_page.py": (
        r"test_a_player_opens_at_a_click_and_is_shown_whole\[1600\]",
        "test_a_page_can_be_read_in_the_dark",
    ),
    "strategies/test_arguments.py": (
        "test_strategies_compose_as_strategies_do",
        r"test_the_default_bounds_are_the_widest\[.*\]",
        r"test_the_world_without_an_edge_is_drawn_on_request_only\[.*\]",
    ),
    "strategies/test_growth.py": (
        r"test_every_world_within_the_bounds_grows_and_no_other\[.*-4\]",
    ),
    "strategies/test_lattices.py": (
        r"test_every_number_of_edges_can_be_had\[(31|57)\]",
        r"test_every_number_of_edges_can_be_had\[11\]",
        r"test_every_number_of_edges_can_be_had\[23\]",
        r"test_every_number_of_edges_can_be_had\[30\]",
        r"test_every_number_of_edges_can_be_had\[6\]",
        r"test_every_number_of_edges_can_be_had\[8\]",
        r"test_every_number_of_edges_can_be_had\[9\]",
    ),
    "strategies/test_notes.py": (
        "test_the_failing_example_can_be_pasted_as_it_is_printed",
        "test_the_failing_example_prints_its_world_and_the_run",
        "test_with_hypothesiss_own_switch_on_every_run_carries_its_features",
    ),
    "strategies/test_registration.py": (
        "test_a_mapper_is_drawn_wherever_an_algorithm_is_annotated",
        "test_it_works_from_either_end",
        "test_worlds_are_drawn_wherever_a_world_is_annotated",
    ),
    "strategies/test_sample.py": (
        r"test_arguments_are_numbers_words_and_truth_values\[worlds.min_edges=1, marker.*",
    ),
    "strategies/test_shrinking.py": (
        r"test_a_planted_fault_shrinks_to_within_one_edge_of_its_smallest_world\[.*\]",
        r"test_what_worlds_shrink_to\[<lambda>-m1/1\]",
        r"test_what_worlds_shrink_to\[<lambda>-m2/7\]",
        r"test_what_worlds_shrink_to\[<lambda>-m4/629\]",
        r"test_what_worlds_shrink_to\[is_dear-m11/134485045224\]",
    ),
    "strategies/test_symmetric.py": (
        r"test_well_known_worlds_are_found\[prism-9\]",
        r"test_well_known_worlds_are_found\[torus-18\]",
    ),
    "strategies/test_uniform.py": (
        "test_a_thousand_draws_of_74_worlds_are_spread_evenly",
        "test_they_have_the_edges_that_were_asked_for_and_shrink_towards_rank_0",
    ),
    "test_action.py": (
        "test_a_wheel_is_installed_and_the_mapper_checked_with_it",
        "test_an_input_cannot_become_a_command",
        r"test_the_search_fails_the_step_just_as_it_should\[.*\]",
    ),
    "test_house.py": ("test_the_rooms_and_their_arrows_can_be_drawn_from_memory",),
    "test_layers.py": ("test_every_room_imports_only_what_it_may",),
    "test_packaging.py": (
        "test_the_command_of_the_wheel_works_on_its_own",
        "test_the_tests_in_the_sdist_run_where_it_is_unpacked",
    ),
    "test_pytest_plugin.py": (
        "test_a_junit_file_has_the_worlds_and_the_line",
        "test_a_mapper_that_hangs_fails_and_leaves_the_rest_undecided",
        "test_a_mapper_that_is_too_slow_never_passes",
        "test_a_mapper_that_raises_shows_where",
        "test_a_mark_may_name_a_program",
        "test_a_mark_takes_a_callable_stands_on_classes_and_meets_parameters",
        "test_a_mark_that_cannot_be_meant_is_an_error_of_one_sentence",
        "test_a_target_that_is_none_is_an_error_of_collection",
        "test_marks_without_a_target_mean_that_of_the_option",
        "test_no_text_of_a_mapper_or_its_file_controls_a_terminal",
        "test_the_fixtures_give_a_robot_and_a_report",
        "test_the_help_has_a_group_and_the_mark_is_known",
        "test_the_mapper_runs_once_in_each_world_and_the_body_after_each_claim",
        "test_the_mark_selects_the_tests_of_the_option",
        r"test_the_summary_is_the_same_with_several_processes\[.*\]",
        "test_the_traceback_of_a_bug_of_ours_is_shown_whole",
        "test_tracebacks_show_the_users_code_and_none_of_ours",
        "test_what_is_not_declared_is_skipped_and_does_not_pass",
    ),
    "world/formats/test_planar_code.py": ("test_nautys_grid_of_300_vertices_is_our_lattice",),
    "world/formats/test_world_json.py": ("test_a_world_comes_back_with_all_that_it_carries",),
    "world/test_least_cost.py": (
        r"test_it_is_what_brute_force_finds\[[34]\]",
        r"test_it_proves_every_world_at_the_least_cost\[5\]",
    ),
    "world/drawing/test_heat.py": (
        "test_of_a_large_world_the_part_that_is_shown_is_coloured",
        r"test_every_kind_of_drawing_can_be_coloured\[(nyc|family:random_genus.*)\]",
    ),
    "world/drawing/test_choice.py": ("test_the_same_bytes_in_every_process",),
}
"""Patterns of the names of tests, parameters included, by their file in tests/."""

TESTS = Path(__file__).resolve().parent


def is_long(path: Path, name: str) -> bool:
    """Whether a test is named in `LONG`."""
    if not path.is_relative_to(TESTS):
        return False
    patterns = LONG.get(path.relative_to(TESTS).as_posix(), ())
    return any(re.fullmatch(pattern, name) for pattern in patterns)
