"""The checks: each looks at a stream's rows, its header or its blocks for one kind of promise."""
