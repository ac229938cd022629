"""Write schemas/fleet.schema.json, the JSON Schema of fleet files, from the drivers.

Example: python scripts/fleet_schema.py
"""

import json
from pathlib import Path

from agent_economy.live.fleet_file.schema import fleet_schema
from agent_economy.whole_file import write_whole

FILE = Path(__file__).resolve().parent.parent / "schemas" / "fleet.schema.json"


def main() -> None:
    """Write the file."""
    write_whole(FILE, (json.dumps(fleet_schema(), indent=2) + "\n").encode())


if __name__ == "__main__":
    main()
