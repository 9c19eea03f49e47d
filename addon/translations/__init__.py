# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on says in other languages: a file for each, by the English text.

Blender looks up names and tooltips by itself where it draws them, first in its own translations,
then in these. Sentences that are made at run time are looked up as templates, before their values
are put in: by `rpt_`, `iface_` and `tip_`, as in Blender's own add-ons. `n_` marks a text that is
looked up later. Texts of the core (its warnings, and reasons in exact words) are English alone.
"""

from typing import Any

import bpy

from . import french, german

#: By the language's name in Blender; a dictionary from the English text each.
LANGUAGES = {"de": german.WORDS, "fr": french.WORDS}
#: For names that Blender has in another sense: its handles are those of curves.
CONTEXT = "Orbflow"
# Names of operators are looked up apart from all else.
_CONTEXTS = ("*", "Operator", CONTEXT)
_blender: Any = bpy.app.translations
#: Look a text up for a report, for a label, for a tooltip.
rpt_, iface_, tip_ = (
    _blender.pgettext_rpt,
    _blender.pgettext_iface,
    _blender.pgettext_tip,
)


def n_(text: str) -> str:
    """Marks a text that is looked up where it is shown."""
    return text


def register() -> None:
    """Gives Blender the translations."""
    _blender.register(__name__, _by_context())


def unregister() -> None:
    """Takes them away."""
    _blender.unregister(__name__)


def _by_context() -> dict[str, dict[tuple[str, str], str]]:
    return {
        language: {(context, text): told for text, told in words.items() for context in _CONTEXTS}
        for language, words in LANGUAGES.items()
    }
