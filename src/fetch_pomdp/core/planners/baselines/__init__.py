"""Other people's robots, to compare ours with: each a planner, its source in its docstring, and what was left out.

They are what the paper's Section II says of those works, put into the actions of Section III-B: no question but "this
one?", about one item. None is the system of its authors.

All wait as long as their belief is uniform: in this task the person speaks first.
"""
