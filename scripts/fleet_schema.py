"""Write schemas/fleet.schema.json, the JSON Schema of fleet files, from the drivers.

Example: python scripts/fleet_schema.py
"""

import json
from pathlib import Path

from agent_economy.live.fleet_file.schema import fleet_schema

FILE = Path(__file__).resolve().parent.parent / "schemas" / "fleet.schema.json"


def main() -> None:
    """Write the file."""
    FILE.write_text(json.dumps(fleet_schema(), indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
