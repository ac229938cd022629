"""Compute how many robots a job needs, with a guarantee."""

import agent_economy as ae


def main() -> None:
    """Answer the question of the 2003 thesis."""
    answer = ae.study.run(ae.Scenario.load("classic"))
    print(answer.sentence)
    print(answer.guarantee)


if __name__ == "__main__":
    main()
