"""How the documentation site is built: ``make docs``. Nothing is fetched from the network."""

import shutil
import sys
from pathlib import Path

HERE = Path(__file__).parent
BUILT = HERE / "_build"
sys.path[:0] = [str(HERE / "_ext"), str(HERE.parent / "tests")]

import stylobate  # noqa: E402

project = "stylobate"
author = "The stylobate developers"
copyright = "The stylobate developers, BSD-3-Clause"
version = release = stylobate.__version__
language = "en"

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
    "equations",
    "computed",
    "docstrings",
]
exclude_patterns = ["_build", "_ext"]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}

myst_enable_extensions = ["dollarmath", "deflist", "colon_fence"]
myst_heading_anchors = 3
html_math_renderer = "glyphs"
autodoc_typehints = "none"  # the docstrings say the types
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_param = napoleon_use_rtype = False  # types are words: "array, shape (n,)" is no link

# Examples run on a copy: what they write stays out of the sources.
examples = shutil.copytree(HERE.parent / "gallery", BUILT / "examples", dirs_exist_ok=True)
sphinx_gallery_conf = {
    "examples_dirs": str(examples),
    "gallery_dirs": "gallery",
    "filename_pattern": r"/plot_",
    "ignore_pattern": r"/(?!plot_)[^/]*\.py$",
    "image_scrapers": ("matplotlib", "gallery_figures.scrape"),
    "within_subsection_order": "gallery_figures.order",
    "plot_gallery": "True",
    "show_signature": False,
    "write_computation_times": False,
    "download_all_examples": False,
    "remove_config_comments": True,
}

html_theme = "furo"
html_title = f"stylobate {release}"
COMPUTED = BUILT / "computed" / "static"  # films, made where the measurements lie beside the project
COMPUTED.mkdir(parents=True, exist_ok=True)
html_static_path = ["_static", str(COMPUTED)]
html_extra_path = [str(HERE.parent / "build" / "live")]  # the page of `make live`, which `make docs` makes first
html_css_files = ["site.css"]
html_show_sphinx = False
html_copy_source = False
html_show_sourcelink = False
