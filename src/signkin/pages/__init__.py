"""What a reader opens: the page of a run, the page of the audit, and what they show."""
