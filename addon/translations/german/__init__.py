# SPDX-License-Identifier: GPL-3.0-or-later
"""All of the add-on in German, by the English text."""

from . import messages, names, tooltips

WORDS = names.WORDS | tooltips.WORDS | messages.WORDS
