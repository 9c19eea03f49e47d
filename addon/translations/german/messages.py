# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages in German, by the English text."""

WORDS = {
    ", as by hand": ", wie von Hand",
    ", by hand less": ", von Hand weniger",
    ", by hand more": ", von Hand mehr",
    "about {:.0f} min": "etwa {:.0f} min",
    "about {:.0f} s": "etwa {:.0f} s",
    "and in {:,} material": "und in {:,} Material",
    "and in {:,} materials": "und in {:,} Materialien",
    "and {:,} more": "und {:,} weitere",
    "apply or remove modifier {} first: it holds a sculpt": (
        "zuerst Modifikator {} anwenden oder entfernen: er enthält Skulptiertes"
    ),
    "apply or remove modifier {} of {} first": (
        "zuerst Modifikator {} von {} anwenden oder entfernen"
    ),
    "attribute {}": "Attribut {}",
    "bake of modifier {}": "Bake von Modifikator {}",
    "binding of modifier {}": "Bindung von Modifikator {}",
    "cancelled; nothing was changed": "abgebrochen; nichts wurde geändert",
    "carrying over your data": "Daten übertragen",
    "checking the mesh": "Netz prüfen",
    "closing holes": "Löcher schließen",
    "could not be done: {}": "ging nicht: {}",
    "custom normals": "eigene Normalen",
    "fitting to the surface": "an die Oberfläche anpassen",
    "flat": "flach",
    "guide {} is lost": "Leitlinie {} ist verloren",
    "guides are drawn in a 3D view": "Leitlinien werden in einer 3D-Ansicht gezeichnet",
    "half is kept: modifier {} makes it whole": "eine Hälfte bleibt: Modifikator {} ergänzt sie",
    (
        "has a hole through it like a ring or cup handle, which this primitive cannot have: "
        "choose Automatic"
    ): (
        "hat ein Loch durch sich hindurch wie ein Ring oder Tassenhenkel, was dieses Primitiv "
        "nicht haben kann: Automatisch wählen"
    ),
    (
        "has {:,} hole (open edges), which this primitive cannot have: choose Automatic, or "
        "fill all borders"
    ): (
        "hat {:,} Loch (offene Kanten), was dieses Primitiv nicht haben kann: Automatisch "
        "wählen oder alle Ränder füllen"
    ),
    (
        "has {:,} holes (open edges), which this primitive cannot have: choose Automatic, or "
        "fill all borders"
    ): (
        "hat {:,} Löcher (offene Kanten), was dieses Primitiv nicht haben kann: Automatisch "
        "wählen oder alle Ränder füllen"
    ),
    (
        "has {:,} holes through it like a ring or cup handle, which this primitive cannot "
        "have: choose Automatic"
    ): (
        "hat {:,} Löcher durch sich hindurch wie ein Ring oder Tassenhenkel, was dieses "
        "Primitiv nicht haben kann: Automatisch wählen"
    ),
    "inside and outside cannot be told apart (like a Moebius strip)": (
        "innen und außen sind nicht zu unterscheiden (wie bei einem Möbiusband)"
    ),
    "inside others": "in anderen",
    "into {:,} sheet": "in {:,} Blatt",
    "into {:,} sheets": "in {:,} Blätter",
    "is flat": "ist flach",
    "is too small for this face count": "ist zu klein für diese Anzahl von Flächen",
    "it is linked from another file and cannot be changed": (
        "es ist aus einer anderen Datei verknüpft und kann nicht geändert werden"
    ),
    "it is not in object mode, in which Orbflow works": (
        "es ist nicht im Objektmodus, in dem Orbflow arbeitet"
    ),
    "it is open where modifier {} closes it: switch on Apply Modifiers": (
        "es ist offen, wo Modifikator {} es schließt: Mit Modifikatoren einschalten"
    ),
    "it was changed meanwhile and is left as it is now": (
        "es wurde inzwischen geändert und bleibt, wie es jetzt ist"
    ),
    "laying the loops": "Schleifen legen",
    "left out: {}": "weggelassen: {}",
    "level {} of modifier {}": "Stufe {} von Modifikator {}",
    "levels {} to {} of modifier {}": "Stufen {} bis {} von Modifikator {}",
    "lies inside another": "liegt in einem anderen",
    "making it solid": "massiv machen",
    "mapping": "abbilden",
    "mean distance to the original {} before, {} now": (
        "mittlerer Abstand zum Original vorher {}, jetzt {}"
    ),
    "measuring": "messen",
    "modifier {} is linked from another file and cannot be applied": (
        "Modifikator {} ist aus einer anderen Datei verknüpft und kann nicht angewandt werden"
    ),
    "modifier {} stays: see whether it fits the new mesh": (
        "Modifikator {} bleibt: bitte prüfen, ob er zum neuen Netz passt"
    ),
    "modifiers applied: {}": "angewandte Modifikatoren: {}",
    "modifiers {} leave no faces; instances have to be realized first": (
        "Modifikatoren {} lassen keine Flächen übrig; Instanzen müssen zuerst realisiert werden"
    ),
    (
        "modifiers {} tear it open where vertices only lie on each other: merge them by "
        "distance, or switch off Apply Modifiers"
    ): (
        "Modifikatoren {} reißen es auf, wo Punkte nur aufeinander liegen: nach Abstand "
        "zusammenführen oder Mit Modifikatoren ausschalten"
    ),
    "no collection, object or annotation with lines is named '{}'; there are: {}": (
        "keine Sammlung, kein Objekt und keine Annotation mit Linien heißt '{}'; es gibt: {}"
    ),
    "no face is selected: in edit mode the selected ones are remeshed": (
        "keine Fläche ist ausgewählt: im Bearbeitungsmodus werden die ausgewählten neu vernetzt"
    ),
    "no half can be kept: modifier {} mirrors otherwise than across one axis of the object": (
        "keine Hälfte kann bleiben: Modifikator {} spiegelt anders als über eine Achse des Objekts"
    ),
    "no half can be kept: {:,} faces cross the plane, {}": (
        "keine Hälfte kann bleiben: {:,} Flächen kreuzen die Ebene, {}"
    ),
    "no vertex group or color attribute is named '{}'; there are: {}": (
        "keine Punktgruppe und kein Farbattribut heißt '{}'; es gibt: {}"
    ),
    "no vertex group, face set or face attribute is named '{}'; there are: {}": (
        "keine Punktgruppe, kein Face Set und kein Flächenattribut heißt '{}'; es gibt: {}"
    ),
    "none": "nichts",
    "not carried over: {}": "nicht übertragen: {}",
    "nothing that is shown of the guides lies where it is": (
        "nichts von dem, was von den Leitlinien zu sehen ist, liegt, wo es ist"
    ),
    "nothing was drawn on {}": "auf {} wurde nichts gezeichnet",
    "pairing triangles into quads": "Dreiecke zu Quads paaren",
    "part of {}: {}": "Teil aus {}: {}",
    "shape key {}": "Formschlüssel {}",
    "shipped": "mitgeliefert",
    "starting": "beginnen",
    "taken apart at {:,} edge at which 3 or more faces meet": (
        "an {:,} Kante zerlegt, an der 3 oder mehr Flächen zusammentreffen,"
    ),
    "taken apart at {:,} edges at which 3 or more faces meet": (
        "an {:,} Kanten zerlegt, an denen 3 oder mehr Flächen zusammentreffen,"
    ),
    "that could not be done": "bei denen es nicht ging",
    "the original of {} is gone": "das Original von {} ist weg",
    "too small for this face count": "zu klein für diese Anzahl von Flächen",
    "unfolding": "auffalten",
    "vertex groups": "Punktgruppen",
    "which is not its middle": "die nicht seine Mitte ist",
    "whose inside and outside cannot be told apart (like a Moebius strip)": (
        "bei denen innen und außen nicht zu unterscheiden sind (wie bei einem Möbiusband)"
    ),
    (
        "with a hole through it like a ring or cup handle, which this primitive cannot have: "
        "choose Automatic"
    ): (
        "mit einem Loch hindurch wie ein Ring oder Tassenhenkel, was dieses Primitiv nicht "
        "haben kann: Automatisch wählen"
    ),
    (
        "with holes (open edges), which this primitive cannot have: choose Automatic, or fill "
        "all borders"
    ): (
        "mit Löchern (offenen Kanten), was dieses Primitiv nicht haben kann: Automatisch "
        "wählen oder alle Ränder füllen"
    ),
    "{0}, {1:,} × {1:,} pixels, is packed": "{0}, {1:,} × {1:,} Pixel, ist gepackt",
    "{:,} border filled": "{:,} Rand gefüllt",
    "{:,} borders filled": "{:,} Ränder gefüllt",
    "{:,} closed surface": "{:,} geschlossene Oberfläche",
    "{:,} closed surfaces": "{:,} geschlossene Oberflächen",
    "{:,} done": "{:,} fertig",
    "{:,} face": "{:,} Fläche",
    "{:,} face now": "{:,} Fläche jetzt",
    "{:,} face selected": "{:,} Fläche ausgewählt",
    "{:,} faces selected": "{:,} Flächen ausgewählt",
    "{:,} face of fewer than 3 corners": "{:,} Fläche mit weniger als 3 Ecken",
    "{:,} face on what was closed for good": "{:,} Fläche auf endgültig Geschlossenem",
    "{:,} face that is there twice": "{:,} doppelt vorhandene Fläche",
    "{:,} faces": "{:,} Flächen",
    "{:,} faces became {:,}": "{:,} Flächen wurden {:,}",
    "{:,} faces now": "{:,} Flächen jetzt",
    "{:,} faces of fewer than 3 corners": "{:,} Flächen mit weniger als 3 Ecken",
    "{:,} faces on what was closed for good": "{:,} Flächen auf endgültig Geschlossenem",
    "{:,} faces that are there twice": "{:,} doppelt vorhandene Flächen",
    "{:,} followed": "{:,} gefolgt",
    "{:,} guide": "{:,} Leitlinie",
    "{:,} guide drawn on {name}": "{:,} Leitlinie auf {name} gezeichnet",
    "{:,} guide erased": "{:,} Leitlinie radiert",
    "{:,} guides": "{:,} Leitlinien",
    "{:,} guides are lost": "{:,} Leitlinien sind verloren",
    "{:,} guides drawn on {name}": "{:,} Leitlinien auf {name} gezeichnet",
    "{:,} guides erased": "{:,} Leitlinien radiert",
    "{:,} handle sealed": "{:,} Henkel verschlossen",
    "{:,} handles sealed": "{:,} Henkel verschlossen",
    "{:,} hidden face is shown again": "{:,} verborgene Fläche ist wieder zu sehen",
    "{:,} hidden faces are shown again": "{:,} verborgene Flächen sind wieder zu sehen",
    "{:,} laid": "{:,} gelegt",
    "{:,} left out: too small to be made thick": "{:,} weggelassen: zu klein für eine Dicke",
    "{:,} level of Multires": "{:,} Stufe Multires",
    "{:,} level of Subdivision and Shrinkwrap": "{:,} Stufe Unterteilung und Shrinkwrap",
    "{:,} levels of Multires": "{:,} Stufen Multires",
    "{:,} levels of Subdivision and Shrinkwrap": "{:,} Stufen Unterteilung und Shrinkwrap",
    "{:,} loose edge": "{:,} lose Kante",
    "{:,} loose edges": "{:,} lose Kanten",
    "{:,} loose vertex": "{:,} loser Punkt",
    "{:,} loose vertices": "{:,} lose Punkte",
    "{:,} lost": "{:,} verloren",
    "{:,} made thick": "{:,} verdickt",
    "{:,} of {:,} parts left as they were": "{:,} von {:,} Teilen geblieben, wie sie waren",
    "{:,} of {:,} parts left out": "{:,} von {:,} Teilen weggelassen",
    "{:,} of {}": "{:,} von {}",
    "{:,} of {} are lost: {}": "{:,} von {} sind verloren: {}",
    "{:,} of {} is lost: {}": "{:,} von {} ist verloren: {}",
    "{:,} parts {}": "{:,} Teile {}",
    "{:,} refused": "{:,} abgelehnt",
    "{:,} shell": "{:,} Hülle",
    "{:,} shells": "{:,} Hüllen",
    "{:,} speck left out": "{:,} Splitter weggelassen",
    "{:,} specks left out": "{:,} Splitter weggelassen",
    "{:,} triangle back to back with another": "{:,} Dreieck Rücken an Rücken mit einem anderen",
    "{:,} triangles back to back with others": "{:,} Dreiecke Rücken an Rücken mit anderen",
    "{:,} turned inside out": "{:,} umgestülpt",
    "{:,} vertex of seams welded": "{:,} Punkt von Nähten verschweißt",
    "{:,} vertices of seams welded": "{:,} Punkte von Nähten verschweißt",
    "{:,} with open edges closed": "{:,} mit offenen Kanten geschlossen",
    "{:,} with warnings": "{:,} mit Warnungen",
    "{:.0f} % of the marks of edges and breaks of custom normals are gone: no edge lies there": (
        "{:.0f} % der Markierungen von Kanten und der Brüche eigener Normalen sind weg: dort "
        "liegt keine Kante"
    ),
    "{:.0f} % of the marks of edges are gone: no edge lies there": (
        "{:.0f} % der Markierungen von Kanten sind weg: dort liegt keine Kante"
    ),
    "{:.2f} % of size": "{:.2f} % der Größe",
    "{:.2f} edges": "{:.2f} Kanten",
    "{:.3f} % of size": "{:.3f} % der Größe",
    "{:.3f} % of size (at most {:.2f} %)": "{:.3f} % der Größe (höchstens {:.2f} %)",
    "{} \nIn exact words: {}": "{} \nIm genauen Wortlaut: {}",
    "{} has changed since": "{} hat sich seitdem geändert",
    "{} has no UV map to bake to": "{} hat keine UV-Map, in die gebacken werden kann",
    "{} has no faces": "{} hat keine Flächen",
    "{} has no original: tick Original before Orbflow Remesh": (
        "{} hat kein Original: vor Orbflow Remesh Original anhaken"
    ),
    "{} is not there or not visible": "{} ist nicht da oder nicht sichtbar",
    "{} is {:.0f} % of its size from its original: are they still one shape?": (
        "{} ist {:.0f} % seiner Größe von seinem Original entfernt: ist es noch dieselbe Form?"
    ),
    "{} left": "noch {}",
    "{} made {}": "{} wurden {}",
    "{} off": "{} daneben",
    "{} was left as it was": "{} blieb, wie es war",
    "{}, stroke {:,}": "{}, Strich {:,}",
    "{}; left out": "{}; weggelassen",
    "{}; see the panel": "{}; siehe Bedienfeld",
}
