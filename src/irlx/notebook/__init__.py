"""Programs in the cells of a notebook: `%load_ext irlx`, then `%%irl`."""
