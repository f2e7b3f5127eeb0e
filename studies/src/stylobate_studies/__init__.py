"""Studies beside the package: the founding paper, measured tests, speed. They use stylobate, which knows nothing of them."""
