"""The tests that take longest: `make slow` and `make nightly` run them, `make test` does not.

A test is named here if it takes more than about three seconds, or holds two processors up by
waiting. `.ci/run` runs all of them, so that a change is asked everything before it is taken.
"""

import re
from pathlib import Path

SLOW: dict[str, tuple[str, ...]] = {
    # The largest sizes of statements whose smaller sizes `make test` runs.
    "checkers/test_check.py": (r"test_no_claim_fails_for_any_algorithm_on_any_world\[4\]",),
    "harness/test_gap.py": ("test_the_basic_algorithm_has_the_largest",),
    "harness/test_pool.py": (
        r"test_results_are_equal_byte_for_byte_however_many_work\[enhancement.*\]",
        "test_the_item_that_hangs_is_found",
        "test_all_worlds_that_kill_their_workers_are_found",
        "test_a_shard_that_strangers_kill_again_and_again_is_cut_down_to_worlds_and_done",
        "test_a_mapper_that_cannot_be_interrupted_is_given_up",
    ),
    "harness/test_ledger.py": ("test_killed_at_random_moments_it_ends_with_the_same_totals",),
    "proofs/bounded/test_encoding.py": (
        r"test_the_maps_are_exactly_those_that_an_exploration_can_draw\[3\]",
    ),
    "proofs/bounded/test_model_count.py": (
        r"test_the_models_are_exactly_the_canonical_codes\[4-706\]",
    ),
    "proofs/bounded/test_theorems.py": (
        r"test_one_door_theorems_hold_in_all_worlds_up_to_four_edges\[bounded-pose\]",
        r"test_whole_words_hold_in_all_worlds_up_to_three_edges\[words-records-.*\]",
        "test_each_question_is_a_script_of_its_own",
    ),
    "proofs/first_order/test_conformance.py": (
        r"test_a_change_inside_an_algorithm_is_seen\[basic.*\]",
        r"test_every_decision_in_every_world_to_four_edges\[enhancement-iii-.*\]",
    ),
    "properties/test_findings.py": (r"test_a_stronger_algorithm_may_cost_more\[.*-m5/177-.*\]",),
    "properties/test_stateful.py": ("test_whatever_is_explored_in_whatever_order_s_stays_true",),
    "strategies/test_arguments.py": (
        "test_strategies_compose_as_strategies_do",
        r"test_the_default_bounds_are_the_widest\[.*\]",
    ),
    "strategies/test_growth.py": (
        r"test_every_world_within_the_bounds_grows_and_no_other\[.*-4\]",
    ),
    "strategies/test_lattices.py": (r"test_every_number_of_edges_can_be_had\[(31|57)\]",),
    "strategies/test_symmetric.py": (r"test_well_known_worlds_are_found\[torus-18\]",),
    "world/test_least_cost.py": (r"test_it_is_what_brute_force_finds\[[34]\]",),
    # Whole commands and examples, whose parts `make test` runs one by one.
    "cli/test_compare.py": ("test_the_page_shows_what_is_printed",),
    "cli/test_exits.py": (
        "test_a_terminal_without_our_letters_gets_others",
        r"test_two_runs_differ_in_timing_alone\[verify .*\]",
    ),
    "cli/test_programs.py": ("test_verify_and_explore_run_programs",),
    "cli/test_prove.py": ("test_two_runs_are_byte_equal_without_the_timing",),
    "cli/test_search.py": ("test_compare_shows_where_the_first_costs_more",),
    "cli/test_verify.py": (
        "test_quick_checks_the_catalogue_in_six_parts",
        r"test_a_faulty_mapper_is_refuted_and_the_line_shows_it_again\[loops .*\]",
    ),
    "examples/test_property_test.py": (
        r"test_it_fails_with_the_world_that_the_page_says\[, simple=True-m3/13\]",
    ),
    "examples/test_pytest_plugin.py": ("test_the_steps_of_the_workflow_work",),
    "harness/conform/test_batch.py": (
        r"test_what_goes_wrong_in_one_world_is_found_there_alone\[hangs-.*\]",
    ),
    "harness/conform/test_conform.py": (
        r"test_the_examples_decide_as_the_reference_event_for_event\[(c|js)\]",
        r"test_the_number_of_workers_changes_nothing\[3\]",
    ),
    "harness/verify/test_proofs.py": ("test_all_that_is_quick_comes_out_as_it_must",),
    "harness/verify/test_verify.py": ("test_the_whole_campaign_exhausts_what_it_says",),
    "proofs/test_catalogue.py": ("test_each_question_is_a_whole_script_and_says_what_is_expected",),
}
"""Patterns of the names of tests, parameters included, by their file in tests/."""

TESTS = Path(__file__).resolve().parent


def is_slow(path: Path, name: str) -> bool:
    """Whether a test is named in `SLOW`."""
    if not path.is_relative_to(TESTS):
        return False
    patterns = SLOW.get(path.relative_to(TESTS).as_posix(), ())
    return any(re.fullmatch(pattern, name) for pattern in patterns)
