"""How sphinx-gallery shows the examples: their figures, which pyplot does not know of, and their order.

In ``sphinx_gallery_conf``: ``"image_scrapers": ("matplotlib", "gallery_figures.scrape")`` and
``"within_subsection_order": "gallery_figures.order"``.
"""

from weakref import WeakSet

from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst

#: From one column and one run to many, then what else there is.
ORDER = (
    "plot_notebook_survey.py",
    "plot_notebook_fragility.py",
    "plot_survey.py",
    "plot_own_record.py",
    "plot_critical_amplitude.py",
    "plot_domain.py",
    "plot_compare_models.py",
    "plot_scatter.py",
    "plot_probability.py",
    "plot_as_found.py",
    "plot_pushover_check.py",
    "plot_worth_it.py",
    "plot_record_suite.py",
    "plot_rocking_spectrum.py",
    "plot_collapse.py",
    "plot_portal.py",
    "plot_temple_corner.py",
    "plot_in_space.py",
    "plot_what_shaking.py",
    "plot_many_sites.py",
)

_shown: WeakSet[Figure] = WeakSet()


def scrape(_block, block_vars, gallery_conf):
    """Save the figures that a block has made without pyplot, and return the text that shows them."""
    paths = []
    for value in block_vars["example_globals"].values():
        if isinstance(value, Figure) and value.canvas.manager is None and value not in _shown:
            _shown.add(value)
            paths.append(next(block_vars["image_path_iterator"]))
            value.savefig(paths[-1], dpi=150)
    return figure_rst(paths, gallery_conf["src_dir"])


def order(name):
    """Place of an example; one that is not listed comes last."""
    return ORDER.index(name) if name in ORDER else len(ORDER)
