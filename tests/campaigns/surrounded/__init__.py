"""Parts of the campaign `surroundings`."""
