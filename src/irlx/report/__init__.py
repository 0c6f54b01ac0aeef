"""What a finished run was like: events and summary, for people and machines."""
