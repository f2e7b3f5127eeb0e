"""A column in the browser: the page that ``make live`` writes, and the module of the engine in it."""
