"""Recordings below the server's folder: `store` lists and opens them, `saver` adds new ones."""
