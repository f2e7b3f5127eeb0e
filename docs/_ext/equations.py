"""Equations as drawn glyphs, which every browser shows alike and offline, with the numbers that their source states.

``\\tag{R1}`` in a formula is its number and its label: ``{eq}`R1``` links to it from any page.
"""

import re
from functools import cache
from html import escape

import ziamath
from docutils import nodes
from sphinx.domains.math import MathDomain
from sphinx.transforms import SphinxTransform

TAG = re.compile(r"\\tag\{([^}]*)\}")

PUNCTUATION = re.compile(r"[,.;:)]+")

#: Units of the drawing per em: the formula scales with the text around it.
EM = 16.0

ziamath.config.svg2 = False  # outlines in place: no ids that two formulas of one page could share


class Numbered(SphinxTransform):
    """Make the tag of every displayed formula its label and number, and tie punctuation to formulas in the text."""

    default_priority = 500

    def apply(self, **_: object) -> None:
        """Register the tags of one document."""
        domain: MathDomain = self.env.domains["math"]
        for node in self.document.findall(nodes.math_block):
            match = TAG.search(node.astext())
            if match is None:
                continue
            label = match.group(1)
            domain.note_equation(self.env.docname, label, location=node)
            domain.equations[label] = (self.env.docname, label)
            node["tagged"] = label
            node["ids"].append(nodes.make_id(f"equation-{label}"))
        for node in list(self.document.findall(nodes.math)):
            text = node.next_node(siblings=True)
            mark = PUNCTUATION.match(text) if isinstance(text, nodes.Text) else None
            if mark:  # no line ends between a formula and the comma behind it
                node["behind"] = mark[0]
                node.parent.replace(text, nodes.Text(text[mark.end() :]))


@cache
def drawn(tex: str, inline: bool) -> str:
    """A formula as an SVG element, sized in em and standing on the line of its text."""
    formula = ziamath.Latex(tex, size=EM, inline=inline, color="currentColor")
    svg = formula.svg()
    sized = re.sub(r'\b(width|height)="([\d.]+)"', lambda m: f'{m[1]}="{float(m[2]) / EM:.4f}em"', svg, count=2)
    style = f"vertical-align:{formula.getyofst() / EM:.4f}em"
    return sized.replace("<svg ", f'<svg role="img" aria-label="{escape(tex)}" style="{style}" ', 1)


def visit_inline(self, node: nodes.math) -> None:
    """Write a formula in a line of text."""
    self.body.append(f'<span class="math">{drawn(node.astext(), True)}{node.get("behind", "")}</span>')
    raise nodes.SkipNode


def visit_block(self, node: nodes.math_block) -> None:
    """Write a displayed formula with its number."""
    self.body.append(self.starttag(node, "div", CLASS="math"))
    self.body.append(f'<div class="formula">{drawn(TAG.sub("", node.astext()).strip(), False)}</div>')
    if "tagged" in node:
        self.body.append(f'<span class="eqno">({escape(node["tagged"])})')
        self.add_permalink_ref(node, "Link to this equation")
        self.body.append("</span>")
    self.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app):
    app.add_transform(Numbered)
    app.add_html_math_renderer("glyphs", (visit_inline, None), (visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
