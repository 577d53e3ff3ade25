"""`mechkin bench`: run time against error, for any mechanism file.

A *scene* is a mechanism whose rows are closed; a *method* is a way to its answers at one setting,
made by a family (`runs.FAMILIES`); a *measurement* is its time and its errors against what is right
(`truth`). `runs` puts them together, `outputs` writes them. Only `mechkin bench` loads this room.
"""
