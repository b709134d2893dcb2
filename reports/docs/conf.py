"""Sphinx configuration of the documentation; `make docs` builds it offline into reports/site."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))

import bem  # noqa: E402

for guide in (HERE.parents[1] / "bem" / "kinds").glob("*/guide.md"):
    page = HERE / "kinds" / f"{guide.parent.name.replace('_', '-')}.md"
    text = guide.read_text("utf-8")
    if not page.is_file() or page.read_text("utf-8") != text:  # a page that is written anew is built anew
        page.write_text(text, "utf-8")

project = "bem"
author = copyright = "the authors of bem"
version = release = bem.__version__.split("+")[0]
html_title = "bem"

extensions = [
    "sphinx.ext.autodoc",
    "numpydoc",
    "myst_nb",
    "sphinx_design",
    "sphinx_copybutton",
    "sphinxcontrib.bibtex",
    "reports.docs.directives",
    "reports.docs.mathml",
]
root_doc = "index"
exclude_patterns = ["**/.ipynb_checkpoints"]
default_role = "literal"

myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence", "deflist", "attrs_inline", "attrs_block"]
myst_heading_anchors = 3
nb_execution_mode = "off"
bibtex_bibfiles = ["../../bem/references.bib"]
bibtex_default_style = "plain"
bibtex_reference_style = "author_year"

autodoc_member_order = "bysource"
autodoc_typehints = "none"
autodoc_preserve_defaults = True
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False
numpydoc_xref_param_type = False

html_theme = "pydata_sphinx_theme"
html_show_sourcelink = False
html_copy_source = False
html_show_sphinx = False
html_use_index = False
html_static_path = ["_static"]
html_css_files = ["bem.css"]
html_theme_options = {
    "show_prev_next": True,
    "navigation_with_keys": False,
    "navbar_align": "left",
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "show_toc_level": 2,
    "header_links_before_dropdown": 7,
}
html_math_renderer = "mathml"
html_math_renderer_default = "mathml"
