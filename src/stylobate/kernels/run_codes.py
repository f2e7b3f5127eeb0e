"""Numbers that loops over lanes and the models around them share: states of a run, size of a block, lengths of chunks."""

#: State of a lane: its run goes on, has ended, has collapsed, has failed; or there is none.
RUNNING, ENDED, COLLAPSED, FAILED, FREE = range(5)

#: Lanes of a block. The same for a single run, so that it has the bits of the batch.
LANES = 16

#: Steps between two looks at the lanes: peaks, ends and collapses are found on this grid. Of beams, the most steps.
CHUNK = 32

#: A part above a joint between drums counts as lost only against this much more restoring acceleration [m/s²]:
#: unlike the base, its support can be carried back under it.
SUPPORT_MARGIN = 9.81
