"""The page on this machine: columns, motions, runs and domains in a browser, computed as on the command line."""
