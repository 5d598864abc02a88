"""A hundred dialogues more, in other rooms and of another style, written before the reader had heard any of them.

They were first read when the reader had been changed by looking at `dialogues.py` alone: 80 of the 100 ended with what
is meant. Since then they are looked at, too. Lines as there; the last ten are in German.
"""

from __future__ import annotations

from tests.core.language.reading.tables import scene

# A bench: five tools near the person, boxes and more behind; the robot faces the person.
SHOP = scene(
    ("red screwdriver", -0.45, 0.6), ("yellow screwdriver", -0.25, 0.6), ("hammer", -0.05, 0.6), ("pliers", 0.15, 0.6),
    ("red wrench", 0.4, 0.6), ("small box screw", -0.4, 0.95), ("large box nail", -0.15, 0.95), ("tape", 0.1, 0.95),
    ("red screwdriver", 0.3, 0.95), ("clamp", 0.5, 0.95),
)  # fmt: skip
OFFICE = scene(
    ("black pen", -0.3, 0.5), ("blue pen", -0.2, 0.5), ("pencil", -0.1, 0.5), ("stapler", 0.25, 0.55),
    ("yellow notebook", -0.35, 0.85), ("green notebook", 0.0, 0.85), ("phone", 0.35, 0.85), ("blue mug", -0.1, 1.15),
    ("white mug", 0.2, 1.15),
)  # fmt: skip
# The robot stands beside the person and looks the same way.
TOYS = scene(
    ("red car", -0.4, 0.6), ("blue car", -0.15, 0.6), ("yellow duck", 0.1, 0.6), ("brown bear", 0.4, 0.6),
    ("red ball", -0.3, 0.9), ("green ball", 0.0, 0.9), ("small green ball", 0.12, 0.95), ("puzzle", 0.4, 1.0),
    ("blue car", 0.2, 1.2),
    robot=(0.05, -0.1, 1.2),
)  # fmt: skip
PANTRY = scene(
    ("white plate", -0.4, 0.55), ("white plate", 0.4, 0.55), ("bread", -0.1, 0.6), ("cheese", 0.1, 0.6),
    ("jar honey", -0.3, 0.9), ("jar jam", -0.1, 0.9), ("jar mustard", 0.1, 0.9), ("glass juice", 0.35, 0.9),
    ("glass milk", 0.0, 1.2), ("tray", -0.35, 1.2),
)  # fmt: skip
TISCH = scene(
    ("rot becher", -0.3, 0.8), ("grün becher", -0.1, 0.8), ("rot becher", 0.1, 0.8), ("weiß schüssel", 0.3, 0.8),
    ("löffel", -0.2, 1.1), ("blau teller", 0.2, 1.1),
)  # fmt: skip
ROOMS = {"shop": SHOP, "office": OFFICE, "toys": TOYS, "pantry": PANTRY, "tisch": TISCH}

UNSEEN = """
shop | the hammer please | 2
shop | a mallet will do | 2
shop | the screwdrivr, the yellow one | 1
shop | the yelow scredriver | 1
shop | not the yellow screwdriver, the red one next to it | 0
shop | the red screwdriver on my left | 0
shop | red screwdriver; ?0; no, the one further away from me | 8
shop | the screwdriver beside the clamp | 8
shop | a spanner | 4
shop | the box of screws | 5
shop | the big box | 6
shop | not the big box, the little one | 5
shop | the boxes... the one with the nails | 6
shop | the sticky tape | 7
shop | what is between the big box and the red screwdriver | 7
shop | in the row closest to me, third from my left | 2
shop | the second thing from my right in the row closest to me | 3
shop | anything red that is no screwdriver | 4
shop | neither of the boxes, the thing right beside the big one, the tape | 7
shop | the red one; ?4; no, not the wrench, the screwdriver near me | 0
shop | the clamp; ?9; yup, that | 9
shop | the pliers. no hang on, the hammer | 2
shop | i'd like the hammer. or better the clamp | 9
shop | the tool left of the hammer from my point of view | 1
shop | red screwdriver; ?8; wrong, the one nearer to me | 0
shop | screwdriver; ?1; no; ?0; not that either | 8
shop | the clamp; the same as before | 9
office | something to write with that is not a pen | 2
office | the pens are empty, give me the pencil | 2
office | the pen next to the pencil | 1
office | the pen that isn't next to the pencil | 0
office | the notebook between the other notebook and the phone | 5
office | my cell phone | 6
office | the staplr | 3
office | coffee mug, the blue one | 7
office | mug; ?7; other one | 8
office | mug; ?8; the other one please | 7
office | the green book; ?5; thats right | 5
office | a book; ?5; no, yellow | 4
office | the middle one of the three things to write with | 1
office | the mug behind the green notebook, on the left as i see it | 7
office | from my seat: the leftmost notebook | 4
office | the telephone, sorry, the stapler | 3
office | the blue thing; ?1; no, the one you drink from | 7
office | the blue thing that is not a mug | 1
office | the last mug from my right | 7
office | whatever is closest to me on my right | 3
office | the pencil; ?2; yeah; no wait, the blue pen | 1
office | both mugs are dirty, so the phone | 6
office | the white mug. actually no, the other mug | 7
office | the stapler; same again please | 3
toys | the blue car at the front | 1
toys | the blue car at the back | 8
toys | the car on the far left | 0
toys | the car beside the duck | 1
toys | blue car; ?8; no the close one | 1
toys | the teddy... the bear | 3
toys | the ball that's not green | 4
toys | the little ball | 6
toys | green ball; ?5; no, the small one | 6
toys | the two green balls: the left one | 5
toys | one of the green balls, the right one | 6
toys | the balls, i want the red one | 4
toys | the yellow animal | 2
toys | an animal but not the duck | 3
toys | the duk | 2
toys | the toy between the blue car and the bear | 2
toys | the thing right of the duck in the front | 3
toys | behind the red car, the ball | 4
toys | first car from the left | 0
toys | second toy from the left in the front row | 1
toys | the jigsaw | 7
toys | the car that is all by itself | 8
toys | cars; ?1; nope, the one to its left | 0
toys | the ball; ?4; no; ?5; no, the one beside it | 6
toys | forget the ball, the puzzle | 7
toys | the ball; on second thought the duck | 2
toys | there are two green balls. the smaller of those | 6
pantry | the jam | 5
pantry | the middle jar of the three | 5
pantry | the jar on my left | 4
pantry | the jar on your left | 6
pantry | plate; ?0; not that one, the one near the cheese | 1
pantry | something i can drink, but no milk | 7
pantry | the drink farthest from me | 8
pantry | the bread; ?2; no, the stuff next to it | 3
pantry | neither the honey nor the mustard, the other jar | 5
pantry | there are three jars. i need the one nearest to the tray | 4
pantry | the mustrad | 6
pantry | no plates, no jars, no glasses, no food: the tray | 9
tisch | gib mir bitte den Löffel | 4
tisch | der rote Becher; ?0; nein, der andere | 2
tisch | der rote Becher; ?2; nein, der links von mir aus | 0
tisch | nicht der Becher, sondern der Teller | 5
tisch | der Becher zwischen den roten | 1
tisch | den grünnen Becher | 1
tisch | der zweite Becher von rechts, von mir aus gesehen | 1
tisch | die Schüssel; ?3; ja genau | 3
tisch | den Teller, ach nein, den Löffel | 4
tisch | Becher; ?1; nein, einen roten, und zwar den neben der Schüssel | 2
"""
