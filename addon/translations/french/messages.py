# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages in French, by the English text."""

WORDS = {
    ", as by hand": ", comme à la main",
    ", by hand less": ", moins à la main",
    ", by hand more": ", plus à la main",
    "about {:.0f} min": "environ {:.0f} min",
    "about {:.0f} s": "environ {:.0f} s",
    "and in {:,} material": "et dans {:,} matériau",
    "and in {:,} materials": "et dans {:,} matériaux",
    "and {:,} more": "et {:,} de plus",
    "apply or remove modifier {} first: it holds a sculpt": (
        "appliquer ou enlever d'abord le modificateur {} : il contient une sculpture"
    ),
    "apply or remove modifier {} of {} first": (
        "appliquer ou enlever d'abord le modificateur {} de {}"
    ),
    "attribute {}": "attribut {}",
    "bake of modifier {}": "précalcul du modificateur {}",
    "binding of modifier {}": "liaison du modificateur {}",
    "cancelled; nothing was changed": "annulé ; rien n'a été modifié",
    "carrying over your data": "transfert des données",
    "checking the mesh": "vérification du maillage",
    "closing holes": "fermeture des trous",
    "could not be done: {}": "n'a pu être fait : {}",
    "custom normals": "normales personnalisées",
    "fitting to the surface": "ajustement à la surface",
    "flat": "plates",
    "guide {} is lost": "le guide {} est perdu",
    "guides are drawn in a 3D view": "les guides se dessinent dans une vue 3D",
    "half is kept: modifier {} makes it whole": (
        "la moitié est gardée : le modificateur {} la complète"
    ),
    (
        "has a hole through it like a ring or cup handle, which this primitive cannot have: "
        "choose Automatic"
    ): (
        "est traversé d'un trou comme un anneau ou l'anse d'une tasse, ce que cette primitive "
        "ne peut avoir : choisir Automatique"
    ),
    (
        "has {:,} hole (open edges), which this primitive cannot have: choose Automatic, or "
        "fill all borders"
    ): (
        "a {:,} trou (arêtes ouvertes), ce que cette primitive ne peut avoir : choisir "
        "Automatique, ou remplir tous les bords"
    ),
    (
        "has {:,} holes (open edges), which this primitive cannot have: choose Automatic, or "
        "fill all borders"
    ): (
        "a {:,} trous (arêtes ouvertes), ce que cette primitive ne peut avoir : choisir "
        "Automatique, ou remplir tous les bords"
    ),
    (
        "has {:,} holes through it like a ring or cup handle, which this primitive cannot "
        "have: choose Automatic"
    ): (
        "est traversé de {:,} trous comme un anneau ou l'anse d'une tasse, ce que cette "
        "primitive ne peut avoir : choisir Automatique"
    ),
    "inside and outside cannot be told apart (like a Moebius strip)": (
        "l'intérieur et l'extérieur ne se distinguent pas (comme un ruban de Möbius)"
    ),
    "inside others": "à l'intérieur d'autres",
    "into {:,} sheet": "en {:,} feuille",
    "into {:,} sheets": "en {:,} feuilles",
    "is flat": "est plat",
    "is too small for this face count": "est trop petit pour ce nombre de faces",
    "it is linked from another file and cannot be changed": (
        "il est lié depuis un autre fichier et ne peut être modifié"
    ),
    "it is not in object mode, in which Orbflow works": (
        "il n'est pas en mode objet, où Orbflow travaille"
    ),
    "it is open where modifier {} closes it: switch on Apply Modifiers": (
        "il est ouvert là où le modificateur {} le ferme : cocher Avec modificateurs"
    ),
    "it was changed meanwhile and is left as it is now": (
        "il a été modifié entre-temps et reste tel qu'il est maintenant"
    ),
    "laying the loops": "tracé des boucles",
    "left out: {}": "laissé de côté : {}",
    "level {} of modifier {}": "niveau {} du modificateur {}",
    "levels {} to {} of modifier {}": "niveaux {} à {} du modificateur {}",
    "lies inside another": "est à l'intérieur d'une autre",
    "making it solid": "passage en solide",
    "mapping": "projection",
    "mean distance to the original {} before, {} now": (
        "distance moyenne à l'original {} avant, {} maintenant"
    ),
    "measuring": "mesure",
    "modifier {} is linked from another file and cannot be applied": (
        "le modificateur {} est lié depuis un autre fichier et ne peut être appliqué"
    ),
    "modifier {} stays: see whether it fits the new mesh": (
        "le modificateur {} reste : voir s'il convient au nouveau maillage"
    ),
    "modifiers applied: {}": "modificateurs appliqués : {}",
    "modifiers {} leave no faces; instances have to be realized first": (
        "les modificateurs {} ne laissent pas de faces ; les instances doivent d'abord être "
        "réalisées"
    ),
    (
        "modifiers {} tear it open where vertices only lie on each other: merge them by "
        "distance, or switch off Apply Modifiers"
    ): (
        "les modificateurs {} le déchirent là où des sommets sont seulement superposés : les "
        "fusionner par distance, ou décocher Avec modificateurs"
    ),
    "no collection, object or annotation with lines is named '{}'; there are: {}": (
        "aucune collection, aucun objet ni annotation avec des lignes ne s'appelle '{}' ; il "
        "y a : {}"
    ),
    "no face is selected: in edit mode the selected ones are remeshed": (
        "aucune face n'est sélectionnée : en mode édition, ce sont les faces sélectionnées "
        "qui sont remaillées"
    ),
    "no half can be kept: modifier {} mirrors otherwise than across one axis of the object": (
        "aucune moitié ne peut être gardée : le modificateur {} reflète autrement que selon "
        "un axe de l'objet"
    ),
    "no half can be kept: {:,} faces cross the plane, {}": (
        "aucune moitié ne peut être gardée : {:,} faces traversent le plan, {}"
    ),
    "no vertex group or color attribute is named '{}'; there are: {}": (
        "aucun groupe de sommets ni attribut de couleur ne s'appelle '{}' ; il y a : {}"
    ),
    "no vertex group, face set or face attribute is named '{}'; there are: {}": (
        "aucun groupe de sommets, ensemble de faces ni attribut de faces ne s'appelle '{}' ; "
        "il y a : {}"
    ),
    "none": "rien",
    "not carried over: {}": "non repris : {}",
    "nothing that is shown of the guides lies where it is": (
        "rien de ce qui se voit des guides ne se trouve où il est"
    ),
    "nothing was drawn on {}": "rien n'a été dessiné sur {}",
    "pairing triangles into quads": "assemblage des triangles en quads",
    "part of {}: {}": "partie de {} : {}",
    "shape key {}": "clé de forme {}",
    "shipped": "fournis",
    "starting": "démarrage",
    "taken apart at {:,} edge at which 3 or more faces meet": (
        "séparé à {:,} arête où 3 faces ou plus se rejoignent"
    ),
    "taken apart at {:,} edges at which 3 or more faces meet": (
        "séparé à {:,} arêtes où 3 faces ou plus se rejoignent"
    ),
    "that could not be done": "qui n'ont pu être faites",
    "the original of {} is gone": "l'original de {} a disparu",
    "too small for this face count": "trop petites pour ce nombre de faces",
    "unfolding": "dépliage",
    "vertex groups": "groupes de sommets",
    "which is not its middle": "qui n'est pas son milieu",
    "whose inside and outside cannot be told apart (like a Moebius strip)": (
        "dont l'intérieur et l'extérieur ne se distinguent pas (comme un ruban de Möbius)"
    ),
    (
        "with a hole through it like a ring or cup handle, which this primitive cannot have: "
        "choose Automatic"
    ): (
        "traversées d'un trou comme un anneau ou l'anse d'une tasse, ce que cette primitive "
        "ne peut avoir : choisir Automatique"
    ),
    (
        "with holes (open edges), which this primitive cannot have: choose Automatic, or fill "
        "all borders"
    ): (
        "avec des trous (arêtes ouvertes), ce que cette primitive ne peut avoir : choisir "
        "Automatique, ou remplir tous les bords"
    ),
    "{0}, {1:,} × {1:,} pixels, is packed": "{0}, {1:,} × {1:,} pixels, est empaquetée",
    "{:,} border filled": "{:,} bord rempli",
    "{:,} borders filled": "{:,} bords remplis",
    "{:,} closed surface": "{:,} surface fermée",
    "{:,} closed surfaces": "{:,} surfaces fermées",
    "{:,} done": "{:,} fait(s)",
    "{:,} face": "{:,} face",
    "{:,} face now": "{:,} face maintenant",
    "{:,} face selected": "{:,} face sélectionnée",
    "{:,} faces selected": "{:,} faces sélectionnées",
    "{:,} face of fewer than 3 corners": "{:,} face de moins de 3 coins",
    "{:,} face on what was closed for good": "{:,} face sur ce qui a été fermé pour de bon",
    "{:,} face that is there twice": "{:,} face en double",
    "{:,} faces": "{:,} faces",
    "{:,} faces became {:,}": "{:,} faces sont devenues {:,}",
    "{:,} faces now": "{:,} faces maintenant",
    "{:,} faces of fewer than 3 corners": "{:,} faces de moins de 3 coins",
    "{:,} faces on what was closed for good": "{:,} faces sur ce qui a été fermé pour de bon",
    "{:,} faces that are there twice": "{:,} faces en double",
    "{:,} followed": "{:,} suivi(s)",
    "{:,} guide": "{:,} guide",
    "{:,} guide drawn on {name}": "{:,} guide dessiné sur {name}",
    "{:,} guide erased": "{:,} guide effacé",
    "{:,} guides": "{:,} guides",
    "{:,} guides are lost": "{:,} guides sont perdus",
    "{:,} guides drawn on {name}": "{:,} guides dessinés sur {name}",
    "{:,} guides erased": "{:,} guides effacés",
    "{:,} handle sealed": "{:,} anse scellée",
    "{:,} handles sealed": "{:,} anses scellées",
    "{:,} hidden face is shown again": "{:,} face cachée est de nouveau visible",
    "{:,} hidden faces are shown again": "{:,} faces cachées sont de nouveau visibles",
    "{:,} laid": "{:,} posé(s)",
    "{:,} left out: too small to be made thick": (
        "{:,} laissée(s) de côté : trop petites pour être épaissies"
    ),
    "{:,} level of Multires": "{:,} niveau de multirésolution",
    "{:,} level of Subdivision and Shrinkwrap": "{:,} niveau de Subdivision et Shrinkwrap",
    "{:,} levels of Multires": "{:,} niveaux de multirésolution",
    "{:,} levels of Subdivision and Shrinkwrap": "{:,} niveaux de Subdivision et Shrinkwrap",
    "{:,} loose edge": "{:,} arête libre",
    "{:,} loose edges": "{:,} arêtes libres",
    "{:,} loose vertex": "{:,} sommet libre",
    "{:,} loose vertices": "{:,} sommets libres",
    "{:,} lost": "{:,} perdu(s)",
    "{:,} made thick": "{:,} épaissie(s)",
    "{:,} of {:,} parts left as they were": "{:,} sur {:,} parties laissées telles quelles",
    "{:,} of {:,} parts left out": "{:,} sur {:,} parties laissées de côté",
    "{:,} of {}": "{:,} sur {}",
    "{:,} of {} are lost: {}": "{:,} sur {} sont perdus : {}",
    "{:,} of {} is lost: {}": "{:,} sur {} est perdu : {}",
    "{:,} parts {}": "{:,} parties {}",
    "{:,} refused": "{:,} refusé(s)",
    "{:,} shell": "{:,} coque",
    "{:,} shells": "{:,} coques",
    "{:,} speck left out": "{:,} éclat laissé de côté",
    "{:,} specks left out": "{:,} éclats laissés de côté",
    "{:,} triangle back to back with another": "{:,} triangle dos à dos avec un autre",
    "{:,} triangles back to back with others": "{:,} triangles dos à dos avec d'autres",
    "{:,} turned inside out": "{:,} retournée(s)",
    "{:,} vertex of seams welded": "{:,} sommet de coutures soudé",
    "{:,} vertices of seams welded": "{:,} sommets de coutures soudés",
    "{:,} with open edges closed": "{:,} à arêtes ouvertes fermée(s)",
    "{:,} with warnings": "{:,} avec avertissements",
    "{:.0f} % of the marks of edges and breaks of custom normals are gone: no edge lies there": (
        "{:.0f} % des marques d'arêtes et des ruptures de normales personnalisées ont disparu "
        ": aucune arête n'y est"
    ),
    "{:.0f} % of the marks of edges are gone: no edge lies there": (
        "{:.0f} % des marques d'arêtes ont disparu : aucune arête n'y est"
    ),
    "{:.2f} % of size": "{:.2f} % de la taille",
    "{:.2f} edges": "{:.2f} arêtes",
    "{:.3f} % of size": "{:.3f} % de la taille",
    "{:.3f} % of size (at most {:.2f} %)": "{:.3f} % de la taille (au plus {:.2f} %)",
    "{} \nIn exact words: {}": "{} \nEn termes exacts : {}",
    "{} has changed since": "{} a changé depuis",
    "{} has no UV map to bake to": "{} n'a pas de carte UV où précalculer",
    "{} has no faces": "{} n'a pas de faces",
    "{} has no original: tick Original before Orbflow Remesh": (
        "{} n'a pas d'original : cocher Original avant Orbflow Remesh"
    ),
    "{} is not there or not visible": "{} n'est pas là ou n'est pas visible",
    "{} is {:.0f} % of its size from its original: are they still one shape?": (
        "{} est à {:.0f} % de sa taille de son original : est-ce encore la même forme ?"
    ),
    "{} left": "encore {}",
    "{} made {}": "{} devenues {}",
    "{} off": "{} d'écart",
    "{} was left as it was": "{} est resté tel quel",
    "{}, stroke {:,}": "{}, trait {:,}",
    "{}; left out": "{} ; laissé de côté",
    "{}; see the panel": "{} ; voir le panneau",
}
