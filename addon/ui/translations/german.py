# SPDX-License-Identifier: GPL-3.0-or-later
"""German: {words of the interface: their translation}, in the terms of Blender's own translation."""

_NAMES = {
    "-X": "-X",
    "-Y": "-Y",
    "-Z": "-Z",
    "Active": "Aktiv",
    "Active Curve": "Aktive Kurve",
    "Active Landmark": "Aktive Landmarke",
    "Active UV Map Only": "Nur aktive UV-Map",
    "Add": "Hinzufügen",
    "Add Landmark": "Landmarke hinzufügen",
    "Add Landmark Curve": "Landmarkenkurve hinzufügen",
    "Advanced": "Erweitert",
    "Align": "Ausrichten",
    "Aligned": "Ausgerichtet",
    "All": "Alle",
    "Allow Overlap": "Überlappung erlauben",
    "Angle Weight": "Winkelgewicht",
    "Animate": "Animieren",
    "Any": "Beliebig",
    "Area": "Fläche",
    "Area Tolerance": "Flächentoleranz",
    "Area ↔ Shape": "Fläche ↔ Form",
    "Authalic was updated": "Authalic wurde aktualisiert",
    "Drag Marker": "Marke ziehen",
    "Energy": "Energie",
    "Feature": "Merkmal",
    "Feature Weight": "Gewicht des Merkmals",
    "Keep Areas": "Flächeninhalte erhalten",
    "Keep Shapes": "Formen erhalten",
    "Like Poses": "Gleiche Posen",
    "Live": "Live",
    "Mirror Landmarks over X": "Landmarken über X spiegeln",
    "Mirror over X": "Über X spiegeln",
    "Offsets": "Verschiebungen",
    "On": "Ein",
    "Reverse These": "Diese umkehren",
    "Save your work and restart Blender": "Arbeit sichern und Blender neu starten",
    "Shape": "Form",
    "Smooth": "Glatt",
    "Strain Attribute": "Dehnung als Attribut",
    "Tolerance": "Toleranz",
    "Unwrap the active object again while options change": (
        "Das aktive Objekt erneut abwickeln, während sich Optionen ändern"
    ),
    "The figures of the last live unwrap": "Die Kennzahlen der letzten Live-Abwicklung",
    "Areas Only": "Nur Flächen",
    "As It Should Be": "Wie es sein soll",
    "Authalic": "Authalic",
    "Authalic Heat Map": "Authalic-Heatmap",
    "Authalic Sphere Shape Key": "Authalic-Shape-Key zur Kugel",
    "Authalic Unwrap": "Authalic-Abwicklung",
    "Automatic": "Automatisch",
    "Axis-Aligned": "Achsenparallel",
    "Balanced": "Ausgewogen",
    "Cancel": "Abbrechen",
    "Circle": "Kreis",
    "Clear Existing": "Vorhandene löschen",
    "Clear Landmark Curves": "Landmarkenkurven löschen",
    "Clear Landmarks": "Landmarken löschen",
    "Closed Meshes": "Geschlossene Meshes",
    "Color Attributes": "Farbattribute",
    "Correct Aspect": "Seitenverhältnis korrigieren",
    "Custom": "Benutzerdefiniert",
    "Default Preset": "Standardvorgabe",
    "Density": "Dichte",
    "Disk": "Scheibe",
    "Distortion": "Verzerrung",
    "Domain": "Zielform",
    "Done": "Fertig",
    "Draft": "Entwurf",
    "Each Island": "Jede Insel",
    "Each by Itself": "Jedes für sich",
    "End": "Ende",
    "End Frame": "Letztes Bild",
    "Error": "Fehler",
    "Even": "Gleichmäßig",
    "Export Landmarks": "Landmarken exportieren",
    "Few Seams": "Wenige Nähte",
    "Figures": "Kennzahlen",
    "Fill Holes": "Löcher füllen",
    "Finish Early": "Vorzeitig beenden",
    "Fix Flips": "Umgeklappte reparieren",
    "Fixed Point": "Fixpunkt",
    "Flipped": "Umgeklappt",
    "Fraction": "Bruchteil",
    "Free": "Frei",
    "Front": "Vorderseite",
    "Gauss-Newton": "Gauß-Newton",
    "Given": "Gegeben",
    "Gradient Descent": "Gradientenabstieg",
    "Heat Map": "Heatmap",
    "Heat Map of": "Heatmap der",
    "Import Landmarks": "Landmarken importieren",
    "Index": "Index",
    "Iterations": "Iterationen",
    "Jump to Landmark": "Zur Landmarke springen",
    "Keep Off": "Freihalten",
    "Keep Position": "Position behalten",
    "Keep Position and Scale": "Position und Skalierung behalten",
    "Lambert Cylindrical": "Lambert-Zylinder",
    "Landmark Curves": "Landmarkenkurven",
    "Landmark Points": "Landmarken",
    "Landmark Weight": "Landmarkengewicht",
    "Landmarks": "Landmarken",
    "Layout": "Layout",
    "Legend": "Legende",
    "Low Shear": "Wenig Scherung",
    "Manual": "Handbuch",
    "Margin": "Abstand",
    "Margin Method": "Abstandsmethode",
    "Mark Seams": "Nähte markieren",
    "Mark Seams Automatically": "Nähte automatisch markieren",
    "Max Islands": "Höchstzahl der Inseln",
    "Measure": "Messen",
    "Measure Area Distortion": "Flächenverzerrung messen",
    "Method": "Methode",
    "Morph": "Verformung",
    "Name": "Name",
    "None": "Keine",
    "Objects": "Objekte",
    "Octahedral": "Oktaeder",
    "Off": "Aus",
    "Opacity": "Deckkraft",
    "Outline": "Umriss",
    "Packing": "Packen",
    "Pick Landmarks": "Landmarken anklicken",
    "Pick on the source ({name})": "Auf der Quelle ({name}) anklicken",
    "Pick on the source or the target": "Auf der Quelle oder dem Ziel anklicken",
    "Pick on the target ({name})": "Auf dem Ziel ({name}) anklicken",
    "Pixels per Meter": "Pixel je Meter",
    "Pixels per meter": "Pixel je Meter",
    "Pole Axis": "Polachse",
    "Prefer": "Bevorzugen",
    "Preset": "Vorgabe",
    "Preview": "Vorschau",
    "Range": "Bereich",
    "Rectangle": "Rechteck",
    "Remove Landmark": "Landmarke entfernen",
    "Remove Landmark Curve": "Landmarkenkurve entfernen",
    "Reverse Landmark Curve": "Landmarkenkurve umkehren",
    "Reverse Source": "Quelle umkehren",
    "Reverse Target": "Ziel umkehren",
    "Rotation": "Drehung",
    "Scale": "Skalierung",
    "Scaled": "Skaliert",
    "Seam Direction": "Nahtrichtung",
    "Seams": "Nähte",
    "Select Landmark Curve": "Landmarkenkurve auswählen",
    "Select Reported": "Gemeldete auswählen",
    "Select Reported Islands": "Gemeldete Inseln auswählen",
    "Select Worst": "Schlechteste auswählen",
    "Set Texel Density": "Texeldichte setzen",
    "Shape Keys": "Shape-Keys",
    "Shear": "Scherung",
    "Shear Preset": "Scherungsvorgabe",
    "Show Heat Map": "Heatmap anzeigen",
    "Show Markers": "Markierungen anzeigen",
    "Side": "Seite",
    "Side by Side": "Nebeneinander",
    "Size": "Größe",
    "Size of Image": "Größe des Bildes",
    "Soft": "Weich",
    "Source": "Quelle",
    "Source Vertex": "Vertex der Quelle",
    "Source Vertices": "Vertices der Quelle",
    "Sphere": "Kugel",
    "Sphere Shape Key": "Shape-Key zur Kugel",
    "Start Frame": "Erstes Bild",
    "Mask": "Maske",
    "Merge by Distance": "Nach Abstand verschmelzen",
    "Bend": "Biegen",
    "Other Pieces": "Andere Teile",
    "Swap": "Tauschen",
    "Swap Source and Target": "Quelle und Ziel tauschen",
    "Symmetry": "Symmetrie",
    "Target": "Ziel",
    "Target Vertex": "Vertex des Ziels",
    "Target Vertices": "Vertices des Ziels",
    "Texel Density": "Texeldichte",
    "Threads": "Threads",
    "To Source": "Zur Quelle",
    "To Target": "Zum Ziel",
    "Together": "Gemeinsam",
    "Too Large": "Zu groß",
    "Too Small": "Zu klein",
    "Transfer": "Übertragen",
    "Transfer from Target": "Vom Ziel übertragen",
    "Transfer through Landmarks": "Durch Landmarken übertragen",
    "UV Map": "UV-Map",
    "UV Map on Target": "UV-Map auf dem Ziel",
    "UV Maps": "UV-Maps",
    "Undo": "Rückgängig",
    "Update Last Operation": "Letzte Operation aktualisieren",
    "Use Subdivision Surface": "Unterteilungsoberfläche verwenden",
    "Vertex Groups": "Vertexgruppen",
    "Weight": "Gewicht",
    "Which": "Welche",
    "With the Surface": "Mit der Oberfläche",
    "World": "Welt",
    "Worst": "Schlechteste",
    "Wrap": "Umhüllen",
    "Wrap and Morph": "Umhüllen und Verformen",
    "Wrap onto Target": "Um das Ziel hüllen",
    "X": "X",
    "Y": "Y",
    "Z": "Z",
}

_TOOLTIPS = {
    "A vertex group or attribute of both meshes that should agree: painted weights, curvature, a "
    "depth. Empty for none": (
        "Eine Vertexgruppe oder ein Attribut beider Meshes, das übereinstimmen soll: gemalte Gewichte, "
        "Krümmung, eine Tiefe. Leer für keines"
    ),
    "Areas alone, as in the papers. By curves: the paper's harmonic map, which keeps angles": (
        "Flächeninhalte allein, wie in den Veröffentlichungen. Bei Kurven: die harmonische Abbildung, "
        "die Winkel erhält"
    ),
    "Areas and angles, measured between the two meshes: knees stay knees": (
        "Flächeninhalte und Winkel, zwischen den beiden Meshes gemessen: Knie bleiben Knie"
    ),
    "For bodies in like poses: how strongly each vertex is pulled to its own position, after the two "
    "are aligned. 0 for other poses": (
        "Für Körper in gleichen Posen: wie stark jeder Vertex zu seiner eigenen Position gezogen wird, "
        "nachdem beide ausgerichtet sind. 0 für andere Posen"
    ),
    "How strongly a soft pair pulls": "Wie stark ein weiches Paar zieht",
    "How strongly the feature pulls what agrees together": (
        "Wie stark das Merkmal zusammenzieht, was übereinstimmt"
    ),
    "Landmark curves and boundaries, exactly along their whole length": (
        "Landmarkenkurven und Ränder, genau und auf ganzer Länge"
    ),
    "Landmark points, as closely as faces can follow": "Landmarken, so genau die Flächen folgen können",
    "How pieces that are not matched, such as eyes, follow the surface around them": (
        "Wie Teile, die nicht zugeordnet werden, etwa Augen und Kleidung, der Oberfläche um sie folgen"
    ),
    "Pieces are moved, rotated and scaled as a whole": "Teile werden als Ganzes bewegt, gedreht und skaliert",
    "Pieces bend with the surface, as shoes and gloves should": (
        "Teile biegen sich mit der Oberfläche, wie es Schuhe und Handschuhe sollen"
    ),
    "Small pieces keep their shapes, large ones bend": "Kleine Teile behalten ihre Form, große biegen sich",
    "All boundaries are filled": "Alle Ränder werden gefüllt",
    "The longest boundaries are matched, all others are filled. Normals must be on the same side": (
        "Die längsten Ränder werden zugeordnet, alle anderen gefüllt. Normalen müssen auf derselben "
        "Seite sein"
    ),
    "Merge the vertices of open edges that lie on each other, so that faces are joined.\n\nUV maps, "
    "landmarks and shape keys stay": (
        "Die Vertices offener Kanten verschmelzen, die aufeinanderliegen, damit Flächen verbunden "
        "sind.\n\nUV-Maps, Landmarken und Shape-Keys bleiben"
    ),
    "Move the target beside the object, so that both can be seen and picked, or back to where it "
    "stood.\n\nMorphs and transfers go by where it stood": (
        "Das Ziel neben das Objekt stellen, damit beide zu sehen und anzuklicken sind, oder zurück an "
        "seinen Platz.\n\nFormänderungen und Übertragungen gelten für seinen Platz davor"
    ),
    "Reverse the target's paths of the curves that fitted far better in reverse in the last registration": (
        "Die Wege auf dem Ziel umkehren, deren Kurven in der letzten Registrierung umgekehrt viel "
        "besser passten"
    ),
    "Store how far each face is stretched or shrunk, 1 for not at all, as the face attribute "
    "authalic_strain": (
        "Wie stark jedes Face gedehnt oder gestaucht wird, 1 für gar nicht, als Face-Attribut "
        "authalic_strain speichern"
    ),
    "The object whose vertices are merged": "Das Objekt, dessen Vertices verschmolzen werden",
    "The object that is wrapped": "Das Objekt, das verformt wird",
    "The object that it is wrapped onto": "Das Objekt, in das es verformt wird",
    "A disk for islands with a boundary, a sphere for closed ones without handles": (
        "Eine Scheibe für Inseln mit Rand, eine Kugel für geschlossene ohne Henkel"
    ),
    "A disk for surfaces with a boundary, a sphere for closed ones and where one is closed": (
        "Eine Scheibe für Oberflächen mit Rand, eine Kugel für geschlossene und wo eine geschlossen ist"
    ),
    "A rectangle as long as the equator. The poles are its upper and lower sides; faces at the seam "
    "extend beyond the right side": (
        "Ein Rechteck so lang wie der Äquator. Die Pole sind seine obere und untere Seite; Flächen an "
        "der Naht ragen über die rechte Seite hinaus"
    ),
    "A square with the upper pole in the middle and the lower pole in its corners. Faces at the seam "
    "extend a little beyond its sides": (
        "Ein Quadrat mit dem oberen Pol in der Mitte und dem unteren in den Ecken. Flächen an der Naht "
        "ragen ein wenig über die Seiten hinaus"
    ),
    "A vertex group or color attribute that says where more texture is wanted: faces of the weight or "
    "brightness 1 should get eight times as much as those of 0. Empty for the same everywhere": (
        "Eine Vertexgruppe oder ein Farbattribut für den Bedarf an Textur: Flächen mit Gewicht oder "
        "Helligkeit 1 sollen achtmal so viel bekommen wie solche mit 0. Leer für überall gleich viel"
    ),
    "A vertex group to keep seams off, such as a face: with the weight 0.5 a seam costs ten times as "
    "much there, with the weight 1 there is none unless there is no other way": (
        "Eine Vertexgruppe, die frei von Nähten bleiben soll, etwa ein Gesicht: Beim Gewicht 0,5 kostet "
        "eine Naht dort das Zehnfache, beim Gewicht 1 gibt es keine, außer es geht nicht anders"
    ),
    "A vertex group where seams are preferred, such as the inside of a sleeve: with the weight 1 a seam "
    "costs a quarter there": (
        "Eine Vertexgruppe, in der Nähte bevorzugt werden, etwa die Innenseite eines Ärmels: Beim "
        "Gewicht 1 kostet eine Naht dort ein Viertel"
    ),
    "A vertex group whose vertices, from a weight of 0.5 on, are not matched. On the object that is "
    "wrapped they follow their surroundings": (
        "Eine Vertexgruppe, deren Vertices ab einem Gewicht von 0,5 nicht zugeordnet werden. Auf dem "
        "Objekt, das verformt wird, folgen sie ihrer Umgebung"
    ),
    "Add a shape key whose slider morphs the active object into its target, landmarks onto "
    "landmarks.\n\nShapes or areas are kept. The normals of both meshes\nmust face "
    "the same way (with curves only if the meshes are open), or the map is mirrored: recalculate or\nflip "
    "the normals of one mesh": (
        "Einen Shape-Key hinzufügen, dessen Regler das aktive Objekt in sein Ziel verformt, Landmarken "
        "auf Landmarken.\n\nFormen oder Flächeninhalte bleiben erhalten. Die "
        "Normalen beider Meshes müssen zur selben Seite zeigen (bei Kurven nur, wenn die Meshes offen "
        "sind), sonst wird gespiegelt: Die Normalen eines Meshes neu berechnen oder umdrehen"
    ),
    'Add the shape key "Authalic Sphere", whose slider morphs a closed mesh into a sphere of the same '
    "area.\n\nEach face's area on the sphere is proportional to its area on the mesh; no face folds over": (
        'Den Shape-Key "Authalic Sphere" hinzufügen, dessen Regler ein geschlossenes Mesh in eine Kugel '
        "gleicher Oberfläche verformt.\n\nJede Fläche nimmt auf der Kugel so viel Platz ein, wie ihr auf "
        "dem Mesh zukommt; keine klappt um"
    ),
    "All alike, as the target must be to lie over the object": (
        "Alle gleich, wie das Ziel auf das Objekt zu legen ist"
    ),
    "All islands get it together, and keep their sizes beside each other": (
        "Alle Inseln bekommen sie gemeinsam und behalten ihre Größen im Vergleich"
    ),
    "All islands that the report named": "Alle Inseln, die der Bericht genannt hat",
    "All objects share one texture, at one texel density": (
        "Alle Objekte teilen sich eine Textur, mit einer Texeldichte"
    ),
    "Allowed deviation of the areas: shapes become as good as possible within it, and Angle Weight is "
    "not used. 0 turns it off": (
        "Erlaubte Abweichung der Flächeninhalte: Innerhalb davon werden die Formen so gut wie möglich, "
        "das Winkelgewicht gilt dann nicht. 0 schaltet sie aus"
    ),
    "Any angle. An island that is alone lies level": (
        "Jeder Winkel. Eine Insel, die allein ist, liegt waagerecht"
    ),
    "Areas as even as possible, whatever the shapes; open islands fill a circle": (
        "Flächeninhalte so gleichmäßig wie möglich, gleich welche Formen; offene Inseln füllen einen Kreis"
    ),
    "Areas even to about a percent, shapes as good as that allows": (
        "Flächeninhalte auf etwa ein Prozent genau, Formen so gut, wie das erlaubt"
    ),
    "As in Blender's back view": "Wie in Blenders Ansicht von hinten",
    "As in Blender's bottom view": "Wie in Blenders Ansicht von unten",
    "As in Blender's front view": "Wie in Blenders Ansicht von vorn",
    "As in Blender's left view": "Wie in Blenders Ansicht von links",
    "As in Blender's right view": "Wie in Blenders Ansicht von rechts",
    "As in Blender's top view": "Wie in Blenders Ansicht von oben",
    "As in the papers. The least even": "Wie in den Veröffentlichungen. Am wenigsten gleichmäßig",
    "As in the papers: conjugate gradients on disks, gradient descent on spheres. Less even": (
        "Wie in den Veröffentlichungen: konjugierte Gradienten auf Scheiben, Gradientenabstieg auf "
        "Kugeln. Weniger gleichmäßig"
    ),
    "As offsets from the keys they are relative to, with their masks, values and drivers. Morphs between "
    "both are left out": (
        "Als Verschiebungen gegen die Keys, auf die sie sich beziehen, mit Masken, Werten und Treibern. "
        "Verformungen zwischen beiden bleiben weg"
    ),
    "As the surface around each vertex is turned and scaled": (
        "Wie die Oberfläche um jeden Vertex gedreht und skaliert ist"
    ),
    "Better shapes, areas nearly as even": "Bessere Formen, Flächeninhalte fast so gleichmäßig",
    "By face corner; seams stay seams": "Je Flächenecke; Nähte bleiben Nähte",
    "Clear the seams that are marked, and find all of them anew": (
        "Die markierten Nähte löschen und alle neu suchen"
    ),
    "Color the faces of selected meshes by how their UV map treats them, in the 3D view and in the UV "
    "editor. Flipped faces have stripes": (
        "Die Flächen der ausgewählten Meshes danach färben, wie ihre UV-Map sie behandelt, in der "
        "3D-Ansicht und im UV-Editor. Umgeklappte Flächen haben Streifen"
    ),
    "Copy only the active UV map of the target": "Nur die aktive UV-Map des Ziels übertragen",
    "Copy UV maps, vertex groups, colors and shape keys from the target to the active object.\n\nSelected "
    "objects with the same target get them too. The registration of both meshes says where they go.\n"
    "Layers of the same names are replaced": (
        "UV-Maps, Vertexgruppen, Farben und Shape-Keys vom Ziel auf das aktive Objekt übertragen.\n\n"
        "Ausgewählte Objekte mit demselben Ziel erhalten sie auch. Die Zuordnung beider Meshes sagt, wohin. "
        "Ebenen gleichen Namens werden ersetzt"
    ),
    "Draw quick seams over the 3D view while the options change. Nothing is marked": (
        "Schnelle Nähte über die 3D-Ansicht zeichnen, während sich die Optionen ändern. Nichts wird markiert"
    ),
    "Draw the landmarks and landmark curves of selected objects, with their numbers": (
        "Die Landmarken und Landmarkenkurven ausgewählter Objekte mit ihren Nummern zeichnen"
    ),
    "Draw what the colors stand for into the corner of the views": (
        "In die Ecke der Ansichten zeichnen, wofür die Farben stehen"
    ),
    "Empty for a number": "Leer für eine Nummer",
    "Error of the last registration at this pair, in percent of the target's size. Negative if there was "
    "none": (
        "Fehler der letzten Zuordnung bei diesem Paar, in Prozent der Größe des Ziels. Negativ, wenn es "
        "keine gab"
    ),
    "Every island fills a circle": "Jede Insel füllt einen Kreis",
    "Every island fills a rectangle, with corners chosen automatically": (
        "Jede Insel füllt ein Rechteck, dessen Ecken selbst gewählt werden"
    ),
    "Every island gets the density": "Jede Insel bekommt die Dichte",
    "Every island gets the outline that suits its shape": (
        "Jede Insel bekommt den Umriss, der zu ihrer Form passt"
    ),
    "Every object fills a texture of its own": "Jedes Objekt füllt eine eigene Textur",
    "Fewer seams, with which islands may overlap themselves when they are unwrapped": (
        "Weniger Nähte, mit denen Inseln beim Abwickeln sich selbst überlappen können"
    ),
    "For open meshes: write the map under which both coincide as a UV map of the target too": (
        "Bei offenen Meshes: die Abbildung, unter der sich beide decken, auch als UV-Map des Ziels schreiben"
    ),
    "How far from the mirrored place a vertex may be, as a part of the size of its object": (
        "Wie weit ein Vertex vom gespiegelten Ort entfernt sein darf, als Anteil der Größe seines Objekts"
    ),
    "How packing may turn islands": "Wie das Packen Inseln drehen darf",
    "How the offsets of shape keys are turned and scaled": (
        "Wie die Verschiebungen der Shape-Keys gedreht und skaliert werden"
    ),
    "Initial pull on the landmarks; it grows until they meet": (
        "Anfänglicher Zug an den Landmarken; er wächst, bis sie sich treffen"
    ),
    "Interpolate weights, colors and shape keys without the facets of the target": (
        "Gewichte, Farben und Shape-Keys ohne die Facetten des Ziels interpolieren"
    ),
    "Islands are not turned to be packed": "Inseln werden beim Packen nicht gedreht",
    "Islands lie level or upright in their minimal rectangle": (
        "Inseln liegen waagerecht oder aufrecht in ihrem kleinsten Rechteck"
    ),
    "Iteration limit of the solver. 0 for as many as usually suffice": (
        "Höchstzahl der Iterationen. 0 für so viele, wie meist genügen"
    ),
    "Just add the margin, ignoring any UV scale": (
        "Den Abstand einfach hinzufügen, gleich welche Skalierung die UVs haben"
    ),
    "Keep shapes on the active image where it is not square": (
        "Formen auf dem aktiven Bild erhalten, wo es nicht quadratisch ist"
    ),
    "Key-frame the shape key from 0 to 1": "Den Shape-Key von 0 bis 1 mit Keyframes versehen",
    "Leave empty to keep the name, or to use a number": "Leer, um den Namen zu behalten oder für eine Nummer",
    "Leave islands where their UVs are, at their size. Islands without UVs are packed": (
        "Inseln lassen, wo ihre UVs sind, in ihrer Größe. Inseln ohne UVs werden gepackt"
    ),
    "Let an open landmark curve start at its other end: open curves are matched start to start": (
        "Eine offene Landmarkenkurve am anderen Ende beginnen lassen: Offene Kurven werden Anfang auf "
        "Anfang gelegt"
    ),
    "Let the object and its target change places, with all landmarks and landmark curves between "
    "them.\n\nShape keys and UV maps of earlier registrations stay where they are": (
        "Objekt und Ziel die Plätze tauschen lassen, mit allen Landmarken und Landmarkenkurven "
        "dazwischen.\n\nShape-Keys und UV-Maps früherer Zuordnungen bleiben, wo sie sind"
    ),
    "Let the outline of an island overlap itself where that gives better shapes. No face is flipped, but "
    "parts of an island may lie over each other": (
        "Den Umriss einer Insel sich überlappen lassen, wo das bessere Formen gibt. Keine Fläche klappt "
        "um, aber Teile einer Insel können übereinander liegen"
    ),
    "Linear on each face of the target": "Linear auf jedem Face des Ziels",
    "Low Shear, but Few Seams for scans: meshes whose edges are below 0.8 % of their size, or that would "
    "need more than 20 slits": (
        "Wenig Scherung, aber wenige Nähte bei Scans: Meshes, deren Kanten unter 0,8 % ihrer Größe "
        "liegen oder die mehr als 20 Schlitze bräuchten"
    ),
    "Make areas even on the surface of the Subdivision Surface modifier, if it is the first": (
        "Flächeninhalte auf der Oberfläche des Modifikators Unterteilungsoberfläche ausgleichen, wenn er "
        "der erste ist"
    ),
    "Make each face's UV area proportional to its surface area": (
        "Jeder Fläche UV-Platz im Verhältnis ihres Flächeninhalts geben"
    ),
    "Make the selected edges a landmark curve: an open path or a closed loop, on this object or its "
    "target.\n\nEdges on one object alone complete the active curve if it lacks a path there. Open "
    "curves are matched\nstart to start: a path starts at the end nearer to the active vertex or edge": (
        "Die ausgewählten Kanten zu einer Landmarkenkurve machen: ein offener Weg oder eine geschlossene "
        "Schleife, auf diesem Objekt oder seinem Ziel.\n\nKanten auf nur einem Objekt ergänzen die "
        "aktive Kurve, wenn ihr dort ein Weg fehlt. Offene Kurven werden Anfang auf Anfang gelegt: Ein "
        "Weg beginnt an dem Ende, das dem aktiven Vertex oder der aktiven Kante näher ist"
    ),
    "Map every island onto a disk. It needs a boundary: seams, or an open mesh": (
        "Jede Insel auf eine Scheibe abbilden. Sie braucht einen Rand: Nähte oder ein offenes Mesh"
    ),
    "Map every island onto a sphere. It must be closed, without seams or handles": (
        "Jede Insel auf eine Kugel abbilden. Sie muss geschlossen sein, ohne Nähte und Henkel"
    ),
    "Mark seams along which the mesh unwraps with even areas and little shear.\n\nSeams that are marked "
    "stay and are added to. In edit mode only selected faces are cut, if there are any": (
        "Nähte markieren, mit denen sich das Mesh gleichmäßig und mit wenig Scherung abwickeln "
        "lässt.\n\nMarkierte Nähte bleiben und werden ergänzt. Im Bearbeitungsmodus werden nur "
        "ausgewählte Flächen zerschnitten, wenn es welche gibt"
    ),
    "Mark the seams that are found on the mesh. Those that it has stay": (
        "Die gefundenen Nähte auf dem Mesh markieren. Seine eigenen bleiben"
    ),
    "Mean shear that the seams leave: the long over the short axis of what a UV map makes of a circle. 1 "
    "is none; less shear needs more seams": (
        "Mittlere Scherung, die die Nähte übrig lassen: die lange durch die kurze Achse dessen, was eine "
        "UV-Map aus einem Kreis macht. 1 ist keine; weniger Scherung braucht mehr Nähte"
    ),
    "Measure first, or show the heat map": "Erst messen oder die Heatmap anzeigen",
    "Measure the area distortion of the active UV map, as figures and as a face attribute.\n\nThe "
    "attribute is 0 for a fair share, 1 for double, -1 for half, -20 for a flipped face": (
        "Die Flächenverzerrung der aktiven UV-Map messen, als Kennzahlen und als Flächenattribut.\n\nDas "
        "Attribut ist 0 bei gerechtem Anteil, 1 beim Doppelten, -1 bei der Hälfte, -20 bei einer "
        "umgeklappten Fläche"
    ),
    "Missed by {error:.3f} % of the target's size": "Um {error:.3f} % der Größe des Ziels verfehlt",
    "Move, rotate and scale the target onto the object, so that the shape does not travel while it "
    "morphs. If off, the morph ends where the target is": (
        "Das Ziel auf das Objekt verschieben, drehen und skalieren, damit die Form beim Verformen nicht "
        "wandert. Wenn aus, endet die Verformung dort, wo das Ziel ist"
    ),
    "New seams that leave little shear; those of the mesh do not count. Opens any closed mesh": (
        "Neue Nähte, die wenig Scherung lassen; die des Meshes zählen nicht. Öffnet jedes geschlossene Mesh"
    ),
    "Of vertices and of face corners": "Von Vertices und von Flächenecken",
    "Opacity of the heat map": "Deckkraft der Heatmap",
    "Pair the selected vertex of this object with the selected vertex of its target.\n\nBoth objects "
    "must be in Edit Mode, with one vertex selected on each": (
        "Den ausgewählten Vertex dieses Objekts mit dem seines Ziels paaren.\n\nBeide Objekte müssen im "
        "Bearbeitungsmodus sein, mit je einem ausgewählten Vertex"
    ),
    "Pair the vertices that lie mirrored over X in both objects, for each pair beside the mirror "
    "plane.\n\nLeft and right in names are swapped. Pairs that have a mirrored pair already are left "
    "alone": (
        "Für jedes Paar neben der Spiegelebene die Vertices paaren, die in beiden Objekten über X "
        "gespiegelt liegen.\n\nLinks und rechts in Namen werden vertauscht. Paare, die schon ein "
        "gespiegeltes haben, bleiben, wie sie sind"
    ),
    "Pairs of paths along edges, here and on the target": (
        "Paare von Wegen entlang Kanten, hier und auf dem Ziel"
    ),
    "Pairs of vertices, here and on the target": "Paare von Vertices, hier und auf dem Ziel",
    "Pick pairs of landmarks: click a point on the object and its partner on the target, in either "
    "order.\n\nDrag a marker to move it over the surface": (
        "Landmarkenpaare anklicken: ein Punkt auf dem Objekt und sein Partner auf dem Ziel, in "
        "beliebiger Folge.\n\nEine Marke ziehen, um sie über die Oberfläche zu bewegen"
    ),
    "Pixels per meter on the active image, or on one of 1024 pixels. 0 fills the image": (
        "Pixel je Meter auf dem aktiven Bild oder auf einem von 1024 Pixeln. 0 füllt das Bild"
    ),
    "Poles at the front and the back, seam below": "Pole vorn und hinten, Naht unten",
    "Poles at the left and the right, seam at the back": "Pole links und rechts, Naht hinten",
    "Poles at the top and the bottom, seam at the back": "Pole oben und unten, Naht hinten",
    "Quick seams, a little longer, for tuning the options; the shear is only predicted": (
        "Schnelle, etwas längere Nähte, um die Optionen einzustellen; die Scherung ist nur vorhergesagt"
    ),
    "Remove a pair of landmark curves. The edges themselves stay": (
        "Ein Paar von Landmarkenkurven entfernen. Die Kanten selbst bleiben"
    ),
    "Remove a pair of landmarks": "Ein Landmarkenpaar entfernen",
    "Remove all pairs of landmark curves. The edges themselves stay": (
        "Alle Paare von Landmarkenkurven entfernen. Die Kanten selbst bleiben"
    ),
    "Remove all pairs of landmarks": "Alle Landmarkenpaare entfernen",
    "Replace the landmarks and landmark curves by those of a JSON file.\n\nA file without curves leaves "
    "the curves alone. If there is no target yet, the mesh object that the file\nnames becomes the target": (
        "Landmarken und Landmarkenkurven durch die einer JSON-Datei ersetzen.\n\nEine Datei ohne Kurven "
        "lässt die Kurven in Ruhe. Gibt es noch kein Ziel, wird es das Mesh-Objekt, das die Datei nennt"
    ),
    "Scale UV islands so that a meter of their surface gets a given number of pixels.\n\nIn Edit Mode "
    "the islands of the selected faces, in Object Mode all islands of the selected objects": (
        "UV-Inseln so skalieren, dass ein Meter ihrer Oberfläche eine gegebene Zahl von Pixeln "
        "bekommt.\n\nIm Bearbeitungsmodus die Inseln der ausgewählten Flächen, im Objektmodus alle der "
        "ausgewählten Objekte"
    ),
    "Scale about the center of each island, or of all together; else about the origin of the UV space": (
        "Um die Mitte jeder Insel oder aller zusammen skalieren; sonst um den Ursprung des UV-Raums"
    ),
    "Seams may run anywhere": "Nähte dürfen überall verlaufen",
    "Select the edges of a landmark curve and bring them into view": (
        "Die Kanten einer Landmarkenkurve auswählen und ins Blickfeld holen"
    ),
    "Select the faces of the islands that the last report named, in Edit Mode": (
        "Die Flächen der Inseln, die der letzte Bericht genannt hat, im Bearbeitungsmodus auswählen"
    ),
    "Select the vertex of a landmark and bring it into view": (
        "Den Vertex einer Landmarke auswählen und ins Blickfeld holen"
    ),
    "Shapes matter more than areas": "Formen sind wichtiger als Flächeninhalte",
    "Shear 1.25: shapes come before seams": "Scherung 1,25: Formen gehen vor Nähten",
    "Shear 1.4: seams are about a fifth shorter": "Scherung 1,4: Nähte sind etwa ein Fünftel kürzer",
    "Show or hide the heat map of UV areas or shear": (
        "Die Heatmap der UV-Flächen oder der Scherung anzeigen oder ausblenden"
    ),
    "Smooth between the vertices of the target": "Glatt zwischen den Vertices des Ziels",
    "Space between islands": "Abstand zwischen Inseln",
    "Specify a precise fraction of final UV output": "Einen genauen Bruchteil des fertigen UV-Raums angeben",
    "Symmetric seams where the mesh is symmetric, if they are about as short": (
        "Symmetrische Nähte, wo das Mesh symmetrisch ist, wenn sie etwa so kurz sind"
    ),
    "Take the size of the image of the UV editor, or of the active texture of the active material, if "
    "there is one": (
        "Die Größe des Bildes im UV-Editor oder der aktiven Textur des aktiven Materials nehmen, wenn es "
        "eins gibt"
    ),
    "The UV area of faces over their share: blue is too small, red too large": (
        "Der UV-Platz von Flächen durch ihren Anteil: Blau ist zu klein, Rot zu groß"
    ),
    "The UV map to write; it is added if it is missing. Empty for the active one": (
        "Die UV-Map, die geschrieben wird; sie wird hinzugefügt, wenn sie fehlt. Leer für die aktive"
    ),
    "The algorithm that makes areas even": "Der Algorithmus, der Flächeninhalte gleichmäßig macht",
    "The angle of the seam of a closed island about the pole axis. 0 is at the back (+Y), or below (-Z) "
    "with the poles on Y": (
        "Der Winkel der Naht einer geschlossenen Insel um die Polachse. 0 ist hinten (+Y) oder, mit den "
        "Polen auf Y, unten (-Z)"
    ),
    "The equal-area projection that lays the sphere of a closed island flat": (
        "Die flächentreue Projektion, die die Kugel einer geschlossenen Insel flach auslegt"
    ),
    "The factor above or below its share at which a face has the full color": (
        "Der Faktor über oder unter ihrem Anteil, bei dem eine Fläche die volle Farbe hat"
    ),
    "The figures of the preview": "Die Kennzahlen der Vorschau",
    "The former name of Circle": "Der frühere Name von Kreis",
    "The frame at which the shape key is 0": "Das Bild, bei dem der Shape-Key 0 ist",
    "The frame at which the shape key is 1": "Das Bild, bei dem der Shape-Key 1 ist",
    "The heat map's color of faces with their share, and of no shear": (
        "Die Farbe der Heatmap für Flächen mit ihrem Anteil und ohne Scherung"
    ),
    "The heat map's color of faces with too little of the texture": (
        "Die Farbe der Heatmap für Flächen mit zu wenig Textur"
    ),
    "The heat map's color of faces with too much of the texture or shear": (
        "Die Farbe der Heatmap für Flächen mit zu viel Textur oder Scherung"
    ),
    "The heat map's color of the stripes on flipped faces": (
        "Die Farbe der Heatmap für die Streifen auf umgeklappten Flächen"
    ),
    "The index of the pair in the list, from 0. -1 for the active one": (
        "Der Index des Paares in der Liste, ab 0. -1 für das aktive"
    ),
    "The index of the pair of curves in the list, from 0. -1 for a new pair, or for one that lacks the "
    "path": (
        "Der Index des Kurvenpaares in der Liste, ab 0. -1 für ein neues oder für eines, dem der Weg fehlt"
    ),
    "The index of the pair of curves in the list, from 0. -1 for the active one": (
        "Der Index des Kurvenpaares in der Liste, ab 0. -1 für das aktive"
    ),
    "The island that came out worst, or the first that was left as it was": (
        "Die Insel, die am schlechtesten geraten ist, oder die erste, die blieb, wie sie war"
    ),
    "The islands to select": "Die Inseln, die ausgewählt werden",
    "The last measurement, one figure per line; empty once it no longer applies": (
        "Die letzte Messung, eine Kennzahl je Zeile; leer, sobald sie nicht mehr gilt"
    ),
    "The local axis on which the poles of a closed island lie": (
        "Die lokale Achse, auf der die Pole einer geschlossenen Insel liegen"
    ),
    "The local axis that the front of the mesh faces: seams cost up to three times as much there": (
        "Die lokale Achse, in die die Vorderseite des Meshes zeigt: Nähte kosten dort bis zum Dreifachen"
    ),
    "The long over the short axis of what the UV map makes of a circle: 1 keeps angles": (
        "Die lange durch die kurze Achse dessen, was die UV-Map aus einem Kreis macht: 1 erhält Winkel"
    ),
    "The mesh object that this one is registered with": "Das Mesh-Objekt, dem dieses zugeordnet wird",
    "The most even areas, in few iterations; never folds a face": (
        "Die gleichmäßigsten Flächeninhalte, in wenigen Iterationen; klappt nie eine Fläche um"
    ),
    "The most islands of a mesh, unless the seams that are marked make more. 0 for no limit": (
        "Die meisten Inseln eines Meshes, außer die markierten Nähte machen mehr. 0 für keine Grenze"
    ),
    "The name of this pair of curves": "Der Name dieses Kurvenpaares",
    "The name of this pair of landmarks": "Der Name dieses Landmarkenpaares",
    "The number of threads that compute; 0 for as many as there are processors. Results do not depend on "
    "it": (
        "Die Zahl der Threads, die rechnen; 0 für so viele, wie es Prozessoren gibt. Ergebnisse hängen "
        "nicht davon ab"
    ),
    "The object whose edges to select": "Das Objekt, dessen Kanten ausgewählt werden",
    "The object whose path to reverse": "Das Objekt, dessen Weg umgekehrt wird",
    "The object whose vertex to go to": "Das Objekt, zu dessen Vertex gesprungen wird",
    "The pair of curves that is selected in the list": "Das Kurvenpaar, das in der Liste ausgewählt ist",
    "The pair of landmarks that is selected in the list": (
        "Das Landmarkenpaar, das in der Liste ausgewählt ist"
    ),
    "The pair pulls by a weight, instead of meeting exactly. For shapes that are kept": (
        "Das Paar zieht mit einem Gewicht, statt sich genau zu treffen. Für Formen, die erhalten bleiben"
    ),
    "The path on the target": "Der Weg auf dem Ziel",
    "The path on this object": "Der Weg auf diesem Objekt",
    "The seams along which meshes are cut": "Die Nähte, entlang derer Meshes zerschnitten werden",
    "The seams of the mesh": "Die Nähte des Meshes",
    "The seams of the mesh, and more where faces would be sheared too much": (
        "Die Nähte des Meshes und weitere, wo Flächen zu sehr geschert würden"
    ),
    "The shape that both surfaces are mapped to": "Die Form, auf die beide Oberflächen abgebildet werden",
    "The shape that islands are mapped onto": "Die Form, auf die Inseln abgebildet werden",
    "The shape that open islands take in the UV map": "Die Form, die offene Inseln in der UV-Map annehmen",
    "The shear at which a face has the full color": "Die Scherung, bei der eine Fläche die volle Farbe hat",
    "The shortest seams": "Die kürzesten Nähte",
    "The trade-off between areas and shapes that the panels start with. Scripts start with Even, "
    "whatever is set here": (
        "Die Abwägung zwischen Flächeninhalten und Formen, mit der die Bedienfelder beginnen. Skripte "
        "beginnen mit Gleichmäßig, was auch hier steht"
    ),
    "The unit of the margin": "Die Einheit des Abstands",
    "The value of Shear": "Der Wert der Scherung",
    "The values below": "Die Werte darunter",
    "The vertex on the target": "Der Vertex auf dem Ziel",
    "The vertex on the target object, -1 if it was lost": (
        "Der Vertex auf dem Zielobjekt, -1, wenn er verloren ist"
    ),
    "The vertex on the target. -1 for the selected one": "Der Vertex auf dem Ziel. -1 für den ausgewählten",
    "The vertex on this object": "Der Vertex auf diesem Objekt",
    "The vertex on this object, -1 if it was lost": "Der Vertex auf diesem Objekt, -1, wenn er verloren ist",
    "The vertex on this object. -1 for the selected one": (
        "Der Vertex auf diesem Objekt. -1 für den ausgewählten"
    ),
    "The vertices on the target from start to end; a loop repeats the first one at the end": (
        "Die Vertices auf dem Ziel von Anfang bis Ende; eine Schleife wiederholt den ersten am Ende"
    ),
    "The vertices on this object from start to end; a loop repeats the first one at the end": (
        "Die Vertices auf diesem Objekt von Anfang bis Ende; eine Schleife wiederholt den ersten am Ende"
    ),
    "They keep their directions and lengths in the world": "Sie behalten Richtung und Länge in der Welt",
    "Trade-off between areas and shapes": "Abwägung zwischen Flächeninhalten und Formen",
    "Trade-off between shear and the length of seams": "Abwägung zwischen Scherung und Länge der Nähte",
    "Trade-off: 0 preserves areas, 1 preserves angles": "Abwägung: 0 erhält Flächeninhalte, 1 erhält Winkel",
    "Trade-off: 0 preserves areas, higher values shear less": (
        "Abwägung: 0 erhält Flächeninhalte, höhere Werte scheren weniger"
    ),
    "Turn the flipped faces of the active UV map over, moving as few UVs as possible.\n\nPinned UVs and "
    "the outlines of islands stay, and so do islands without flipped faces": (
        "Die umgeklappten Flächen der aktiven UV-Map zurückklappen und dabei so wenige UVs wie möglich "
        "bewegen.\n\nAngeheftete UVs und die Umrisse der Inseln bleiben, ebenso Inseln ohne umgeklappte "
        "Flächen"
    ),
    "Use scale of existing UVs to multiply margin": (
        "Den Abstand mit der Skalierung vorhandener UVs malnehmen"
    ),
    "Vertex indices on the target from start to end; a loop repeats the first one at the end. Empty for "
    "the selected edges": (
        "Vertexindizes auf dem Ziel von Anfang bis Ende; eine Schleife wiederholt den ersten am Ende. "
        "Leer für die ausgewählten Kanten"
    ),
    "Vertex indices on this object from start to end; a loop repeats the first one at the end. Empty for "
    "the selected edges": (
        "Vertexindizes auf diesem Objekt von Anfang bis Ende; eine Schleife wiederholt den ersten am "
        "Ende. Leer für die ausgewählten Kanten"
    ),
    "Virtually fill holes in the mesh before unwrapping, all but the longest boundary": (
        "Löcher des Meshes vor dem Abwickeln gedacht füllen, alle Ränder außer dem längsten"
    ),
    "Wait for the result of changed options": "Auf das Ergebnis geänderter Optionen warten",
    "What gets the density": "Was die Dichte bekommt",
    "What is matched between the two meshes": "Was zwischen den beiden Meshes aufeinander gelegt wird",
    "What the colors stand for": "Wofür die Farben stehen",
    "What the map from surface to surface keeps": "Was die Abbildung von Oberfläche zu Oberfläche erhält",
    "Where the target has at most half as many faces": "Wo das Ziel höchstens halb so viele Faces hat",
    "Whether seams mirror each other": "Ob Nähte einander spiegeln",
    "Whether several objects share the texture": "Ob mehrere Objekte sich die Textur teilen",
    "Width and height of the texture in pixels, where there is no image": (
        "Breite und Höhe der Textur in Pixeln, wo es kein Bild gibt"
    ),
    "With their weights": "Mit ihren Gewichten",
    "Write the landmarks and landmark curves to a JSON file, with the numbers of their vertices": (
        "Die Landmarken und Landmarkenkurven mit den Nummern ihrer Vertices in eine JSON-Datei schreiben"
    ),
}

WORDS = _NAMES | _TOOLTIPS
