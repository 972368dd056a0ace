"""The fault programme of docs/reliability.md, which tools/torture runs."""
