"""Run a scenario once, many times, and step by step."""

import agent_economy as ae


def main() -> None:
    """Search for four items with four robots."""
    outcome = ae.run("search", seed=7, run=3)
    print(f"run 3: {outcome.status} after {outcome.time_s} s, found {outcome.found}")

    table = ae.replicate("search", runs=200, seed=7)  # a row a run
    print(f"of 200 runs {table['complete'].to_numpy().mean():.0%} found all")

    simulation = ae.Simulation("search", seed=7, run=3)
    simulation.step(300)
    simulation.change("robots.rover.count", 8)  # help arrives after 30 s
    print(f"with help: {simulation.finish().time_s} s")


if __name__ == "__main__":
    main()
