# SPDX-License-Identifier: GPL-3.0-or-later
"""Tooltips and other sentences in German, by the English text."""

WORDS = {
    "A Mirror modifier goes into the result and leaves the stack": (
        "Ein Modifikator Spiegeln geht in das Ergebnis ein und verlässt den Stapel"
    ),
    (
        "A file of weights for the network, as `orbflow train` writes it; empty for those "
        "that come with the add-on. It holds numbers; nothing in it is executed"
    ): (
        "Eine Datei mit Gewichten für das Netzwerk, wie `orbflow train` sie schreibt; leer "
        "für die mitgelieferten. Sie enthält Zahlen; nichts darin wird ausgeführt"
    ),
    "A graph network proposes, the solver mends and grows: faster than Solver and as good": (
        "Ein Graphnetzwerk schlägt vor, der Löser bessert nach und ergänzt: schneller als der "
        "Löser und ebenso gut"
    ),
    "A share of the faces that the object has, modifiers included": (
        "Ein Anteil der Flächen, die das Objekt hat, Modifikatoren eingeschlossen"
    ),
    "A subdivided box: even rows of quads, 8 irregular vertices": (
        "Ein unterteilter Würfel: gleichmäßige Reihen von Quads, 8 unregelmäßige Punkte"
    ),
    "A subdivided icosahedron: 12 irregular vertices": (
        "Ein unterteiltes Ikosaeder: 12 unregelmäßige Punkte"
    ),
    "A subdivision that follows the original, which has to stay": (
        "Eine Unterteilung, die dem Original folgt; dieses muss bleiben"
    ),
    "Across X; a mesh that is not symmetric is made so from the side of positive X": (
        "Über X; ein nicht symmetrisches Netz wird es von der Seite des positiven X her"
    ),
    "Across Y; a mesh that is not symmetric is made so from the side of positive Y": (
        "Über Y; ein nicht symmetrisches Netz wird es von der Seite des positiven Y her"
    ),
    "Across Z; a mesh that is not symmetric is made so from the side of positive Z": (
        "Über Z; ein nicht symmetrisches Netz wird es von der Seite des positiven Z her"
    ),
    "Across the first axis, if any, in which every vertex has its image": (
        "Über die erste Achse, falls es eine gibt, an der jeder Punkt sein Spiegelbild hat"
    ),
    "Another seed places the points of the adaptive primitive differently": (
        "Ein anderer Startwert setzt die Punkte des adaptiven Primitivs anders"
    ),
    "As many faces as it takes for edges of this length": (
        "So viele Flächen, wie es für Kanten dieser Länge braucht"
    ),
    "Bake the original's relief to an image for the UV map, with Cycles, and pack it": (
        "Backt das Relief des Originals mit Cycles in ein Bild für die UV-Map und packt es"
    ),
    "Borders between the face sets of sculpt mode": (
        "Grenzen zwischen den Face Sets des Skulpturmodus"
    ),
    "Borders of islands of the active UV map, marked as seams or not": (
        "Grenzen der Inseln der aktiven UV-Map, ob als Naht markiert oder nicht"
    ),
    (
        "Borders that are longer than this share of the whole mesh's size stay open; 0: all "
        "are filled"
    ): (
        "Ränder, die länger sind als dieser Anteil der Größe des ganzen Netzes, bleiben "
        "offen; 0: alle werden gefüllt"
    ),
    "Close gaps between open edges that lie on each other, as imported seams do": (
        "Schließt Spalte zwischen offenen Kanten, die aufeinander liegen, wie bei "
        "importierten Nähten"
    ),
    (
        "Keep the mesh's own quads where they are good, cut into finer ones or without some "
        "strips: its loops stay. Off: new quads are found"
    ): (
        "Behält die eigenen Quads des Netzes, wo sie gut sind, feiner zerlegt oder ohne "
        "einige Streifen: seine Schleifen bleiben. Aus: neue Quads werden gesucht"
    ),
    "Cycles, which bakes, is switched off in the preferences": (
        "Cycles, das zum Backen gebraucht wird, ist in den Einstellungen ausgeschaltet"
    ),
    (
        "Draw a line on the surface that edges of the result follow; a loop where it ends at "
        "its start"
    ): (
        "Zeichnet eine Linie auf die Oberfläche, der Kanten des Ergebnisses folgen; eine "
        "Schleife, wenn sie an ihrem Anfang endet"
    ),
    (
        "Draw lines and loops on the surface that edges of the result follow.\nCtrl or Shift "
        "erases; a line that ends at its start is a loop"
    ): (
        "Zeichnet Linien und Schleifen auf die Oberfläche, denen Kanten des Ergebnisses "
        "folgen.\nStrg oder Umschalt radiert; eine Linie, die an ihrem Anfang endet, ist eine "
        "Schleife"
    ),
    (
        "Draw the object as it was before the last run over the result, up to this share of "
        "the view from the left"
    ): (
        "Zeichnet das Objekt, wie es vor dem letzten Lauf war, über das Ergebnis, von links "
        "bis zu diesem Anteil der Ansicht"
    ),
    "Edges at which the surface turns by more than this get edges of the result along them": (
        "Kanten, an denen die Oberfläche um mehr als diesen Winkel knickt, bekommen Kanten "
        "des Ergebnisses entlang"
    ),
    "Edges lie on a guide, as on a sharp edge": (
        "Kanten liegen auf einer Leitlinie wie auf einer scharfen Kante"
    ),
    "Edges lie on it exactly, whatever the guide strength is": (
        "Kanten liegen genau darauf, gleich welche Stärke die Leitlinien haben"
    ),
    "Edges marked as seams of the UV map": "Als Nähte der UV-Map markierte Kanten",
    "Edges run along a guide, on it or beside it": (
        "Kanten laufen an einer Leitlinie entlang, auf ihr oder neben ihr"
    ),
    "Finds the map to the sphere by optimisation alone": (
        "Findet die Abbildung auf die Kugel allein durch Optimierung"
    ),
    "Flow for quads, adaptive for triangles": "Fluss für Quads, Adaptiv für Dreiecke",
    "Flowing quads: 0 makes all of one size, 1 much smaller ones where it bends": (
        "Fließende Quads: 0 macht alle gleich groß, 1 viel kleinere, wo es sich krümmt"
    ),
    "Flowing quads: 0 makes smooth loops, 1 lays edges along the curvature": (
        "Fließende Quads: 0 macht glatte Schleifen, 1 legt Kanten entlang der Krümmung"
    ),
    (
        "Flowing quads: collection or object whose curves, Grease Pencil strokes or loose "
        "edges the edges of the result follow, or the annotation; what is hidden guides "
        "nothing"
    ): (
        "Fließende Quads: Sammlung oder Objekt, dessen Kurven, Grease-Pencil-Striche oder "
        "lose Kanten die Kanten des Ergebnisses folgen, oder die Annotation; Ausgeblendetes "
        "leitet nicht"
    ),
    "Flowing quads: makes one side the exact image of the other": (
        "Fließende Quads: macht eine Seite zum genauen Spiegelbild der anderen"
    ),
    (
        "Flowing quads: vertex group or color attribute that says where they are small: most "
        "where it is 1 or white, largest where it is 0 or black; the count stays"
    ): (
        "Fließende Quads: Punktgruppe oder Farbattribut, das sagt, wo sie klein sind: am "
        "kleinsten bei 1 oder Weiß, am größten bei 0 oder Schwarz; die Anzahl bleibt"
    ),
    "Guides is now {} instead of {}": "Leitlinien ist jetzt {} statt {}",
    "Handles stay round which a tight loop is longer than this share of the whole mesh's size": (
        "Henkel bleiben, wenn eine enge Schleife um sie länger ist als dieser Anteil der "
        "Größe des ganzen Netzes"
    ),
    "Handles, as of a cup, stay, and so do holes that go through": (
        "Henkel, wie an einer Tasse, bleiben, durchgehende Löcher auch"
    ),
    "Have the materials read it; those that others use too become the object's own": (
        "Lässt die Materialien es lesen; was auch andere benutzen, wird zur eigenen Kopie des "
        "Objekts"
    ),
    "Holes are closed, all of them or the small ones": (
        "Löcher werden geschlossen, alle oder nur die kleinen"
    ),
    (
        "How edges heed a guide whose name, or that of its layer or material, does not begin "
        "with Follow or Exact"
    ): (
        "Wie Kanten eine Leitlinie beachten, deren Name, oder der ihrer Ebene oder ihres "
        "Materials, nicht mit Follow oder Exact beginnt"
    ),
    "How long edges are in the scene, on the whole": "Wie lang Kanten in der Szene im Ganzen sind",
    "How many bones move a vertex at most; many engines take 4. 0: as many as before": (
        "Wie viele Knochen einen Punkt höchstens bewegen; viele Engines nehmen 4. 0: so viele "
        "wie vorher"
    ),
    "How many faces the result has, as a share of those of the object": (
        "Wie viele Flächen das Ergebnis hat, als Anteil derer des Objekts"
    ),
    "How many faces the result has, within a few percent": (
        "Wie viele Flächen das Ergebnis hat, auf wenige Prozent genau"
    ),
    "How many pixels the image has across and down": (
        "Wie viele Pixel das Bild in Breite und Höhe hat"
    ),
    "How many threads to use; 0 uses all. The result is the same for any number": (
        "Wie viele Threads benutzt werden; 0 nimmt alle. Das Ergebnis ist immer dasselbe"
    ),
    "How often faces are divided by four; 0: as often as it takes": (
        "Wie oft Flächen in vier geteilt werden; 0: so oft wie nötig"
    ),
    "It has no original, and no run of this session made it": (
        "Es hat kein Original, und kein Lauf dieser Sitzung hat es gemacht"
    ),
    "It is linked from another file and cannot be changed": (
        "Es ist aus einer anderen Datei verknüpft und kann nicht geändert werden"
    ),
    (
        "Lay patches of faces on the active mesh, as large as they will be: by the number "
        "that is asked for and by Density, from blue (large) to red (small), not by "
        "Adaptivity"
    ): (
        "Legt Stücke aus Flächen auf das aktive Netz, so groß, wie sie werden: nach der "
        "verlangten Anzahl und nach der Dichte, von Blau (groß) bis Rot (klein), nicht nach "
        "der Anpassung"
    ),
    (
        "Leave a hidden copy of the object as it was beside the result, which keeps the name "
        "and all that points at it"
    ): (
        "Lässt neben dem Ergebnis eine ausgeblendete Kopie des Objekts, wie es war; das "
        "Ergebnis behält den Namen und alles, was darauf verweist"
    ),
    "Leave edit, sculpt or paint mode first": (
        "Zuerst Bearbeitungs-, Skulptur- oder Malmodus verlassen"
    ),
    "Leave sculpt or paint mode first: Orbflow works in object and edit mode": (
        "Zuerst Skulptur- oder Malmodus verlassen: Orbflow arbeitet im Objekt- und "
        "Bearbeitungsmodus"
    ),
    "Levels that can be sculpted on; the original may go then": (
        "Stufen, auf denen modelliert werden kann; das Original kann dann weg"
    ),
    "Make a mesh active in object mode: guides are drawn on it": (
        "Im Objektmodus ein Netz aktiv machen: darauf werden Leitlinien gezeichnet"
    ),
    (
        "Make everything one closed surface first: parts that pass through each other, double "
        "walls, cavities and open pieces"
    ): (
        "Macht zuerst alles zu einer geschlossenen Oberfläche: Teile, die sich durchdringen, "
        "doppelte Wände, Hohlräume und offene Stücke"
    ),
    (
        "Mark the vertices of the active mesh where the grid breaks: blue where one edge is "
        "missing, red where there is one too many, black otherwise"
    ): (
        "Markiert die Punkte des aktiven Netzes, an denen das Raster bricht: blau, wo eine "
        "Kante fehlt, rot, wo es eine zu viel ist, sonst schwarz"
    ),
    "Network for more than some 10,000 faces, where it saves time, else Solver": (
        "Netzwerk bei mehr als etwa 10.000 Flächen, wo es Zeit spart, sonst Löser"
    ),
    "Open edges stay open: lines of edges of the result lie on them": (
        "Offene Kanten bleiben offen: Kantenzüge des Ergebnisses liegen auf ihnen"
    ),
    "Open edges that are no farther apart than this share of the mesh's size": (
        "Offene Kanten, die nicht weiter auseinander liegen als dieser Anteil der Größe des Netzes"
    ),
    "Orbflow is at work; press ESC to stop it": "Orbflow arbeitet; ESC hält es an",
    "Paint where quads are small: red where they are smallest, blue where they are largest": (
        "Malt, wo Quads klein sind: rot, wo sie am kleinsten, blau, wo sie am größten sind"
    ),
    (
        "Parts that are smaller than this share of the whole mesh are small too; 0: only "
        "those that are too small for the faces that they would get"
    ): (
        "Teile, die kleiner sind als dieser Anteil des ganzen Netzes, sind auch klein; 0: nur "
        "solche, die für ihre Flächen zu klein sind"
    ),
    "Put what the result has lost of its original's relief on it, as levels of a Multires": (
        "Legt das Relief des Originals, das dem Ergebnis fehlt, darauf, als Stufen eines Multires"
    ),
    "Rebuild the selected meshes at the number of faces asked for": (
        "Baut die ausgewählten Netze mit der verlangten Anzahl von Flächen neu auf"
    ),
    (
        "Remesh what is seen: modifiers that make geometry, such as Mirror and Subdivision, "
        "go into the result and leave the stack; those that follow a pose or time stay"
    ): (
        "Vernetzt neu, was zu sehen ist: Modifikatoren, die Geometrie machen, wie Spiegeln "
        "und Unterteilung, gehen in das Ergebnis ein und verlassen den Stapel; die einer Pose "
        "oder der Zeit folgen, bleiben"
    ),
    "Select the spot in edit mode. In exact words: {}": (
        "Wählt die Stelle im Bearbeitungsmodus aus. Im genauen Wortlaut: {}"
    ),
    "Select {}": "{} auswählen",
    (
        "Show the field that the quads of the active mesh follow, as found by the last run in "
        "this session"
    ): (
        "Zeigt das Feld, dem die Quads des aktiven Netzes folgen, wie der letzte Lauf dieser "
        "Sitzung es gefunden hat"
    ),
    "Show the object as it was before the last run, or as it is again; nothing is changed": (
        "Zeigt das Objekt, wie es vor dem letzten Lauf war, oder wieder, wie es ist; nichts "
        "wird geändert"
    ),
    "Small ones, as noise in scans has them, are cut and closed": (
        "Kleine, wie das Rauschen von Scans sie hat, werden aufgeschnitten und geschlossen"
    ),
    "Take the tool that draws lines on the surface for edges to follow; Ctrl erases": (
        "Nimmt das Werkzeug, das Linien auf die Oberfläche zeichnet, denen Kanten folgen; "
        "Strg radiert"
    ),
    "The object as it was before Orbflow remeshed it": (
        "Das Objekt, wie es war, bevor Orbflow es neu vernetzt hat"
    ),
    "The result is one half, which the Mirror modifier makes whole as before": (
        "Das Ergebnis ist eine Hälfte, die der Modifikator Spiegeln wie bisher ergänzt"
    ),
    "The selected meshes are linked from another file and cannot be changed": (
        "Die ausgewählten Netze sind aus einer anderen Datei verknüpft und können nicht "
        "geändert werden"
    ),
    (
        "The size of the cells that make it solid: walls and gaps that are thinner than this "
        "share of the mesh's size are lost, smaller cells take more time and memory"
    ): (
        "Größe der Zellen, mit denen massiv gemacht wird: Wände und Spalte, die dünner sind "
        "als dieser Anteil der Größe des Netzes, gehen verloren; kleinere Zellen brauchen "
        "mehr Zeit und Speicher"
    ),
    "The sphere that is deformed into the mesh": "Die Kugel, die zum Netz verformt wird",
    "The two sides of a mesh need not be alike": (
        "Die beiden Seiten eines Netzes müssen nicht gleich sein"
    ),
    "Triangles placed where the surface needs them": (
        "Dreiecke, gesetzt, wo die Oberfläche sie braucht"
    ),
    "UV map {} of {} has no area: unwrap it first": (
        "UV-Map {} von {} hat keine Fläche: zuerst abwickeln"
    ),
    (
        "Vertex group, face set or face attribute whose faces are left as they are; the new "
        "faces join them without a gap"
    ): (
        "Punktgruppe, Face Set oder Flächenattribut, dessen Flächen bleiben, wie sie sind; "
        "die neuen schließen ohne Lücke an"
    ),
    "What becomes of a half that a Mirror modifier makes whole": (
        "Was aus einer Hälfte wird, die ein Modifikator Spiegeln ergänzt"
    ),
    "What becomes of closed parts that lie wholly inside another": (
        "Was aus geschlossenen Teilen wird, die ganz in einem anderen liegen"
    ),
    "What becomes of handles, as of a cup, and of holes that go through": (
        "Was aus Henkeln, wie an einer Tasse, und aus durchgehenden Löchern wird"
    ),
    "What becomes of open edges: those around holes, and of sheets as of cloth": (
        "Was aus offenen Kanten wird: um Löcher herum und an Flächen wie Stoff"
    ),
    "What becomes of parts that are too small for their share of the faces": (
        "Was aus Teilen wird, die für ihren Anteil der Flächen zu klein sind"
    ),
    "Which marks of edges get edges of the result along them, however flat": (
        "Welche Markierungen von Kanten Kanten des Ergebnisses entlang bekommen, wie flach es "
        "dort auch ist"
    ),
    "Who proposes where each vertex lies on the sphere": (
        "Wer vorschlägt, wo jeder Punkt auf der Kugel liegt"
    ),
}
