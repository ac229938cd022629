"""Ask how many robots a job needs, and hear an answer with a guarantee."""

import agent_economy as ae


def main() -> None:
    """Answer the question of the thesis that all of this grew from."""
    answer = ae.study.run(ae.Scenario.load("classic"))
    print(answer.sentence)
    print(answer.guarantee)


if __name__ == "__main__":
    main()
