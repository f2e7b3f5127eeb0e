"""Many times: study files, and campaigns of runs that can be interrupted and resumed."""
