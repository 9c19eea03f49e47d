# SPDX-License-Identifier: GPL-3.0-or-later
"""Tooltips and other sentences in French, by the English text."""

WORDS = {
    "A Mirror modifier goes into the result and leaves the stack": (
        "Un modificateur Miroir passe dans le résultat et quitte la pile"
    ),
    (
        "A file of weights for the network, as `orbflow train` writes it; empty for those "
        "that come with the add-on. It holds numbers; nothing in it is executed"
    ): (
        "Un fichier de poids pour le réseau, tel que `orbflow train` l'écrit ; vide pour ceux "
        "fournis avec l'extension. Il contient des nombres ; rien n'y est exécuté"
    ),
    "A graph network proposes, the solver mends and grows: faster than Solver and as good": (
        "Un réseau de graphes propose, le solveur corrige et complète : plus rapide que le "
        "solveur et aussi bon"
    ),
    "A share of the faces that the object has, modifiers included": (
        "Une part des faces de l'objet, modificateurs compris"
    ),
    "A subdivided box: even rows of quads, 8 irregular vertices": (
        "Une boîte subdivisée : des rangs réguliers de quads, 8 sommets irréguliers"
    ),
    "A subdivided icosahedron: 12 irregular vertices": (
        "Un icosaèdre subdivisé : 12 sommets irréguliers"
    ),
    "A subdivision that follows the original, which has to stay": (
        "Une subdivision qui suit l'original, lequel doit rester"
    ),
    "Across X; a mesh that is not symmetric is made so from the side of positive X": (
        "Selon X ; un maillage non symétrique le devient à partir du côté des X positifs"
    ),
    "Across Y; a mesh that is not symmetric is made so from the side of positive Y": (
        "Selon Y ; un maillage non symétrique le devient à partir du côté des Y positifs"
    ),
    "Across Z; a mesh that is not symmetric is made so from the side of positive Z": (
        "Selon Z ; un maillage non symétrique le devient à partir du côté des Z positifs"
    ),
    "Across the first axis, if any, in which every vertex has its image": (
        "Selon le premier axe, s'il y en a un, pour lequel chaque sommet a son image"
    ),
    "Another seed places the points of the adaptive primitive differently": (
        "Une autre graine place autrement les points de la primitive adaptative"
    ),
    "As many faces as it takes for edges of this length": (
        "Autant de faces qu'il en faut pour des arêtes de cette longueur"
    ),
    "Bake the original's relief to an image for the UV map, with Cycles, and pack it": (
        "Précalcule avec Cycles le relief de l'original dans une image pour la carte UV, et "
        "l'empaquette"
    ),
    "Borders between the face sets of sculpt mode": (
        "Limites entre les ensembles de faces du mode sculpture"
    ),
    "Borders of islands of the active UV map, marked as seams or not": (
        "Limites des îlots de la carte UV active, marquées comme coutures ou non"
    ),
    (
        "Borders that are longer than this share of the whole mesh's size stay open; 0: all "
        "are filled"
    ): (
        "Les bords plus longs que cette part de la taille du maillage entier restent ouverts "
        "; 0 : tous sont remplis"
    ),
    "Close gaps between open edges that lie on each other, as imported seams do": (
        "Ferme les fentes entre des arêtes ouvertes superposées, comme les coutures importées"
    ),
    (
        "Keep the mesh's own quads where they are good, cut into finer ones or without some "
        "strips: its loops stay. Off: new quads are found"
    ): (
        "Garde les quads du maillage là où ils sont bons, découpés plus finement ou sans "
        "certaines bandes : ses boucles restent. Sans : de nouveaux quads sont cherchés"
    ),
    "Cycles, which bakes, is switched off in the preferences": (
        "Cycles, qui précalcule, est désactivé dans les préférences"
    ),
    (
        "Draw a line on the surface that edges of the result follow; a loop where it ends at "
        "its start"
    ): (
        "Dessine sur la surface une ligne que suivent des arêtes du résultat ; une boucle si "
        "elle finit à son début"
    ),
    (
        "Draw lines and loops on the surface that edges of the result follow.\nCtrl or Shift "
        "erases; a line that ends at its start is a loop"
    ): (
        "Dessine sur la surface des lignes et des boucles que suivent des arêtes du "
        "résultat.\nCtrl ou Maj efface ; une ligne qui finit à son début est une boucle"
    ),
    (
        "Draw the object as it was before the last run over the result, up to this share of "
        "the view from the left"
    ): (
        "Dessine l'objet tel qu'il était avant le dernier calcul par-dessus le résultat, de "
        "la gauche jusqu'à cette part de la vue"
    ),
    "Edges at which the surface turns by more than this get edges of the result along them": (
        "Les arêtes où la surface tourne de plus que cet angle reçoivent des arêtes du "
        "résultat le long d'elles"
    ),
    "Edges lie on a guide, as on a sharp edge": (
        "Les arêtes sont sur un guide, comme sur une arête dure"
    ),
    "Edges lie on it exactly, whatever the guide strength is": (
        "Les arêtes sont exactement dessus, quelle que soit la force des guides"
    ),
    "Edges marked as seams of the UV map": "Arêtes marquées comme coutures de la carte UV",
    "Edges run along a guide, on it or beside it": "Les arêtes longent un guide, dessus ou à côté",
    "Finds the map to the sphere by optimisation alone": (
        "Trouve la projection sur la sphère par la seule optimisation"
    ),
    "Flow for quads, adaptive for triangles": "Flux pour les quads, adaptatif pour les triangles",
    "Flowing quads: 0 makes all of one size, 1 much smaller ones where it bends": (
        "Quads en flux : 0 les fait tous de même taille, 1 bien plus petits là où ça courbe"
    ),
    "Flowing quads: 0 makes smooth loops, 1 lays edges along the curvature": (
        "Quads en flux : 0 fait des boucles lisses, 1 place les arêtes le long de la courbure"
    ),
    (
        "Flowing quads: collection or object whose curves, Grease Pencil strokes or loose "
        "edges the edges of the result follow, or the annotation; what is hidden guides "
        "nothing"
    ): (
        "Quads en flux : collection ou objet dont les arêtes du résultat suivent les courbes, "
        "les traits de Grease Pencil ou les arêtes libres, ou l'annotation ; ce qui est caché "
        "ne guide rien"
    ),
    "Flowing quads: makes one side the exact image of the other": (
        "Quads en flux : fait d'un côté l'image exacte de l'autre"
    ),
    (
        "Flowing quads: vertex group or color attribute that says where they are small: most "
        "where it is 1 or white, largest where it is 0 or black; the count stays"
    ): (
        "Quads en flux : groupe de sommets ou attribut de couleur qui dit où ils sont petits "
        ": les plus petits à 1 ou en blanc, les plus grands à 0 ou en noir ; le nombre reste"
    ),
    "Guides is now {} instead of {}": "Guides est maintenant {} au lieu de {}",
    "Handles stay round which a tight loop is longer than this share of the whole mesh's size": (
        "Les anses restent si une boucle serrée autour d'elles est plus longue que cette part "
        "de la taille du maillage entier"
    ),
    "Handles, as of a cup, stay, and so do holes that go through": (
        "Les anses, comme celle d'une tasse, restent, ainsi que les trous traversants"
    ),
    "Have the materials read it; those that others use too become the object's own": (
        "Fait lire la carte par les matériaux ; ceux que d'autres utilisent deviennent "
        "propres à l'objet"
    ),
    "Holes are closed, all of them or the small ones": (
        "Les trous sont fermés, tous ou seulement les petits"
    ),
    (
        "How edges heed a guide whose name, or that of its layer or material, does not begin "
        "with Follow or Exact"
    ): (
        "Comment les arêtes suivent un guide dont le nom, ou celui de son calque ou matériau, "
        "ne commence ni par Follow ni par Exact"
    ),
    "How long edges are in the scene, on the whole": (
        "La longueur des arêtes dans la scène, dans l'ensemble"
    ),
    "How many bones move a vertex at most; many engines take 4. 0: as many as before": (
        "Combien d'os au plus déplacent un sommet ; beaucoup de moteurs en acceptent 4. 0 : "
        "autant qu'avant"
    ),
    "How many faces the result has, as a share of those of the object": (
        "Combien de faces a le résultat, en part de celles de l'objet"
    ),
    "How many faces the result has, within a few percent": (
        "Combien de faces a le résultat, à quelques pour cent près"
    ),
    "How many pixels the image has across and down": (
        "Combien de pixels l'image a en largeur et en hauteur"
    ),
    "How many threads to use; 0 uses all. The result is the same for any number": (
        "Combien de threads utiliser ; 0 les prend tous. Le résultat est toujours le même"
    ),
    "How often faces are divided by four; 0: as often as it takes": (
        "Combien de fois les faces sont divisées en quatre ; 0 : autant qu'il faut"
    ),
    "It has no original, and no run of this session made it": (
        "Il n'a pas d'original, et aucun calcul de cette session ne l'a fait"
    ),
    "It is linked from another file and cannot be changed": (
        "Il est lié depuis un autre fichier et ne peut être modifié"
    ),
    (
        "Lay patches of faces on the active mesh, as large as they will be: by the number "
        "that is asked for and by Density, from blue (large) to red (small), not by "
        "Adaptivity"
    ): (
        "Pose sur le maillage actif des carrés de faces de leur taille future : d'après le "
        "nombre demandé et la densité, du bleu (grand) au rouge (petit), sans l'adaptation"
    ),
    (
        "Leave a hidden copy of the object as it was beside the result, which keeps the name "
        "and all that points at it"
    ): (
        "Laisse à côté du résultat une copie cachée de l'objet tel qu'il était ; le résultat "
        "garde le nom et tout ce qui y renvoie"
    ),
    "Leave edit, sculpt or paint mode first": (
        "Quitter d'abord le mode édition, sculpture ou peinture"
    ),
    "Leave sculpt or paint mode first: Orbflow works in object and edit mode": (
        "Quitter d'abord le mode sculpture ou peinture : Orbflow travaille en mode objet et édition"
    ),
    "Levels that can be sculpted on; the original may go then": (
        "Niveaux que l'on peut sculpter ; l'original peut alors partir"
    ),
    "Make a mesh active in object mode: guides are drawn on it": (
        "Rendre un maillage actif en mode objet : les guides se dessinent dessus"
    ),
    (
        "Make everything one closed surface first: parts that pass through each other, double "
        "walls, cavities and open pieces"
    ): (
        "Fait d'abord du tout une seule surface fermée : parties qui se traversent, doubles "
        "parois, cavités et morceaux ouverts"
    ),
    (
        "Mark the vertices of the active mesh where the grid breaks: blue where one edge is "
        "missing, red where there is one too many, black otherwise"
    ): (
        "Marque les sommets du maillage actif où la grille se rompt : bleu où il manque une "
        "arête, rouge où il y en a une de trop, noir sinon"
    ),
    "Network for more than some 10,000 faces, where it saves time, else Solver": (
        "Réseau au-delà de quelque 10 000 faces, où il fait gagner du temps, sinon solveur"
    ),
    "Open edges stay open: lines of edges of the result lie on them": (
        "Les arêtes ouvertes restent ouvertes : des lignes d'arêtes du résultat sont dessus"
    ),
    "Open edges that are no farther apart than this share of the mesh's size": (
        "Arêtes ouvertes dont l'écart ne dépasse pas cette part de la taille du maillage"
    ),
    "Orbflow is at work; press ESC to stop it": "Orbflow travaille ; Échap l'arrête",
    "Paint where quads are small: red where they are smallest, blue where they are largest": (
        "Peint où les quads sont petits : rouge où ils sont le plus petits, bleu où ils sont "
        "le plus grands"
    ),
    (
        "Parts that are smaller than this share of the whole mesh are small too; 0: only "
        "those that are too small for the faces that they would get"
    ): (
        "Les parties plus petites que cette part du maillage entier sont petites aussi ; 0 : "
        "seulement celles trop petites pour leurs faces"
    ),
    "Put what the result has lost of its original's relief on it, as levels of a Multires": (
        "Remet sur le résultat le relief de l'original qu'il a perdu, en niveaux d'une "
        "multirésolution"
    ),
    "Rebuild the selected meshes at the number of faces asked for": (
        "Reconstruit les maillages sélectionnés avec le nombre de faces demandé"
    ),
    (
        "Remesh what is seen: modifiers that make geometry, such as Mirror and Subdivision, "
        "go into the result and leave the stack; those that follow a pose or time stay"
    ): (
        "Remaille ce qui se voit : les modificateurs qui font de la géométrie, comme Miroir "
        "et Subdivision, passent dans le résultat et quittent la pile ; ceux qui suivent une "
        "pose ou le temps restent"
    ),
    "Select the spot in edit mode. In exact words: {}": (
        "Sélectionne l'endroit en mode édition. En termes exacts : {}"
    ),
    "Select {}": "Sélectionner {}",
    (
        "Show the field that the quads of the active mesh follow, as found by the last run in "
        "this session"
    ): (
        "Montre le champ que suivent les quads du maillage actif, tel que le dernier calcul "
        "de cette session l'a trouvé"
    ),
    "Show the object as it was before the last run, or as it is again; nothing is changed": (
        "Montre l'objet tel qu'il était avant le dernier calcul, ou de nouveau tel qu'il est "
        "; rien n'est modifié"
    ),
    "Small ones, as noise in scans has them, are cut and closed": (
        "Les petites, comme le bruit des scans en a, sont coupées et fermées"
    ),
    "Take the tool that draws lines on the surface for edges to follow; Ctrl erases": (
        "Prend l'outil qui dessine sur la surface des lignes que suivent des arêtes ; Ctrl efface"
    ),
    "The object as it was before Orbflow remeshed it": (
        "L'objet tel qu'il était avant qu'Orbflow le remaille"
    ),
    "The result is one half, which the Mirror modifier makes whole as before": (
        "Le résultat est une moitié, que le modificateur Miroir complète comme avant"
    ),
    "The selected meshes are linked from another file and cannot be changed": (
        "Les maillages sélectionnés sont liés depuis un autre fichier et ne peuvent être modifiés"
    ),
    (
        "The size of the cells that make it solid: walls and gaps that are thinner than this "
        "share of the mesh's size are lost, smaller cells take more time and memory"
    ): (
        "La taille des cellules qui rendent solide : parois et fentes plus minces que cette "
        "part de la taille du maillage sont perdues ; de plus petites cellules prennent plus "
        "de temps et de mémoire"
    ),
    "The sphere that is deformed into the mesh": "La sphère qui est déformée en maillage",
    "The two sides of a mesh need not be alike": (
        "Les deux côtés d'un maillage n'ont pas à être pareils"
    ),
    "Triangles placed where the surface needs them": (
        "Triangles placés là où la surface en a besoin"
    ),
    "UV map {} of {} has no area: unwrap it first": (
        "La carte UV {} de {} n'a pas d'aire : déplier d'abord"
    ),
    (
        "Vertex group, face set or face attribute whose faces are left as they are; the new "
        "faces join them without a gap"
    ): (
        "Groupe de sommets, ensemble de faces ou attribut de faces dont les faces restent "
        "telles quelles ; les nouvelles s'y raccordent sans fente"
    ),
    "What becomes of a half that a Mirror modifier makes whole": (
        "Ce que devient une moitié qu'un modificateur Miroir complète"
    ),
    "What becomes of closed parts that lie wholly inside another": (
        "Ce que deviennent les parties fermées entièrement à l'intérieur d'une autre"
    ),
    "What becomes of handles, as of a cup, and of holes that go through": (
        "Ce que deviennent les anses, comme celle d'une tasse, et les trous traversants"
    ),
    "What becomes of open edges: those around holes, and of sheets as of cloth": (
        "Ce que deviennent les arêtes ouvertes : autour des trous, et de surfaces comme le tissu"
    ),
    "What becomes of parts that are too small for their share of the faces": (
        "Ce que deviennent les parties trop petites pour leur part des faces"
    ),
    "Which marks of edges get edges of the result along them, however flat": (
        "Quelles marques d'arêtes reçoivent des arêtes du résultat le long d'elles, même à plat"
    ),
    "Who proposes where each vertex lies on the sphere": (
        "Qui propose où chaque sommet se trouve sur la sphère"
    ),
}
