"""The fault programme of docs/reliability.md, which tools/lab/torture runs."""
