"""The engine in the plane: bodies, joints by either law, links, and the search for what touches once something is loose."""
