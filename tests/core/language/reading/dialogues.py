"""200 short dialogues, written before the reader had heard any of them.

A line: table | turns, with ";" between them | the item that is meant. A turn "?2" is the robot's question about item 2.
The last third (HELD_BACK) was not looked at while the reader was made.
"""

from __future__ import annotations

from tests.core.language.reading.tables import LINE, ROOM, scene

# The robot stands beside the person and looks the same way.
KITCHEN = scene(
    ("red apple", -0.4, 0.6), ("green apple", -0.2, 0.6), ("spoon", 0.0, 0.6), ("fork", 0.2, 0.6),
    ("blue cup", -0.3, 0.9), ("white cup", 0.1, 0.9), ("bottle water", 0.4, 0.9), ("knife", 0.4, 0.6),
    robot=(0.05, -0.1, 1.2),
)  # fmt: skip
# Three rows of three; the robot faces the person.
GRID = scene(
    ("red block", -0.3, 0.6), ("blue block", 0.0, 0.6), ("red block", 0.3, 0.6),
    ("blue block", -0.3, 0.8), ("yellow block", 0.0, 0.8), ("blue block", 0.3, 0.8),
    ("red block", -0.3, 1.0), ("green block", 0.0, 1.0), ("blue block", 0.3, 1.0),
)  # fmt: skip
TABLES = {"line": LINE, "room": ROOM, "kitchen": KITCHEN, "grid": GRID}

LOOKED_AT = """
line | the green mug | 1
line | could you give me the bowl please | 3
line | the white thing | 3
line | i want the red mug; ?0; no | 2
line | i want the red mug; ?0; no, the other one | 2
line | i want the red mug; ?0; yes | 0
line | i want the red mug; ?0; nope, the green one | 1
line | the mug; ?0; not that one, the other red one | 2
line | the mug; ?0; no, the one to the right of it from my point of view | 1
line | the red mug next to the bowl | 2
line | the mug next to the bowl | 2
line | the mug that is not red | 1
line | not a mug | 3
line | anything but a mug | 3
line | the mug between the red ones | 1
line | the red mug on my left | 0
line | the red mug on my right | 2
line | the red one on your right | 0
line | the red one on your left | 2
line | my leftmost mug | 0
line | second from my left | 1
line | the second one from my right | 2
line | third from my left | 2
line | the last one on my right | 3
line | red mug; red mug; actually the bowl | 3
line | the red mug; no wait, the green one | 1
line | the red mug, i mean the green one | 1
line | the bowl, no sorry, the green mug | 1
line | the mug; ?0; yes; no wait, the green one | 1
line | the grean mug | 1
line | the whte bowl | 3
line | a gren cup | 1
line | the scarlet cup next to the bowl | 2
line | the ivory dish | 3
line | the red mug farthest from the bowl | 0
line | the red mug nearest to the bowl | 2
line | the mug closest to the bowl | 2
line | the mug farthest from the bowl | 0
line | the red one; ?2; no, the left one from my side | 0
line | the one next to the bowl | 2
line | red mug 3 | 2
line | white-bowl-4 | 3
line | the mug; ?1; wrong one, the one next to the bowl | 2
line | the red one. it is the one beside the bowl | 2
line | look at the bowl. take the mug next to it | 2
line | find the green mug, then give me the red one between it and the bowl | 2
room | the black pan | 6
room | the skillet | 6
room | the bowl by itself | 3
room | the lone bowl | 3
room | the bowl next to the pan | 3
room | the middle bowl of the three | 1
room | the middle one of the three bowls in a row | 1
room | there are three bowls close together. take the middle one | 1
room | there are three bowls on my right. i want the one in the middle | 1
room | the plate closest to me | 4
room | the plate near me | 4
room | the plate in front of me | 4
room | the plate closest to you | 5
room | the plate farthest from me | 5
room | the plate farthest from you | 4
room | the plate that is nearer to you | 5
room | the bowl in front of the pan, as i see it | 3
room | the bowl on my far left | 3
room | the bowl on my far right | 2
room | the rightmost bowl from my perspective | 2
room | the leftmost bowl from your perspective | 2
room | the bowl farthest from the pan | 2
room | the white one; ?4; no | 5
room | the white one; ?4; no, the other one | 5
room | the plate; ?5; no the near one | 4
room | the bowl that is not with the others | 3
room | the bowl separated from the others | 3
room | from my point of view, the left bowl of the three in the row | 0
room | from my point of view the right one of the three bowls | 2
room | of the three bowls together, the one farthest from the pan | 2
room | something to eat from that is black; no wait, the saucepan | 6
room | not a bowl and not a plate | 6
room | the second bowl from my right | 1
room | the third bowl from my right | 0
room | a dish; ?0; no, the one on my left | 3
room | the plate; ?4; yes | 4
kitchen | the fork | 3
kitchen | something to drink from that is blue | 4
kitchen | the white mug | 5
kitchen | the apple on the left | 0
kitchen | the left apple | 0
kitchen | the apple on the right | 1
kitchen | the red fruit | 0
kitchen | something to cut with | 7
kitchen | the cup behind the apples | 4
kitchen | the cup behind the apple on the left | 4
kitchen | the thing left of the spoon | 1
kitchen | the thing to the right of the spoon | 3
kitchen | what is between the spoon and the knife | 3
kitchen | the item between the fork and the green apple | 2
kitchen | the rightmost item in the front | 7
kitchen | the cup on the right | 5
kitchen | the cup; ?4; no | 5
kitchen | the cup; ?5; no, the blue one | 4
kitchen | the cup; ?5; yes please | 5
kitchen | an apple; ?0; no, the other | 1
kitchen | an apple; ?0; not that one | 1
kitchen | the apple next to the spoon | 1
kitchen | the apple farthest from the spoon | 0
kitchen | the flask | 6
kitchen | the water | 6
kitchen | the cutlery next to the knife | 3
kitchen | the silverware on the far left | 2
kitchen | the second from the left in the front row | 1
kitchen | the cup close to the bottle | 5
kitchen | teh knive | 7
grid | the yellow one | 4
grid | the block in the middle | 4
grid | the center block | 4
grid | the green one; ?7; yes | 7
grid | the red block closest to you | 6
grid | the blue block closest to me | 1
grid | the blue block farthest from me | 8
grid | the blue block between the two red ones closest to me | 1
grid | the block in front of the green one, from my side | 4
grid | the block behind the yellow one as i see it | 7
grid | the block right of the yellow one from my perspective | 5
grid | the block left of the yellow one from your perspective | 5
grid | the red block on my right | 2
grid | the red block on your left | 2
grid | the block next to the yellow one, on my left | 3
grid | the blue one; ?1; no, the one closest to you | 8
grid | the red one; ?0; no, the one on my right | 2
grid | the red one; ?2; no; ?0; no | 6
"""

HELD_BACK = """
grid | the blue block on my left | 3
grid | not red, not blue, not green | 4
grid | the red one near you | 6
grid | the red one nearest me on my left | 0
grid | the red one nearest me on my right | 2
grid | the block between the yellow one and me | 1
grid | the blue block next to the green one | 8
grid | the blue block farthest from you | 1
grid | give me the emerald block, sorry, the golden one | 4
grid | red; ?0; nope; ?2; yes | 2
grid | the red block; ?6; no, one of the ones near me, the right one from my side | 2
grid | the blue block right behind the red one on my right, seen from my side | 5
grid | in the row closest to me, the one in the middle | 1
grid | in the row closest to me the blue one | 1
grid | the block to the left of the green block from my point of view | 6
grid | the block to the right of the green block from my point of view | 8
grid | the lemon coloured... i mean the yellow block | 4
grid | the yelow blok | 4
grid | do you see the green block? i want the one next to it, the red one | 6
grid | the blue one; ?8; no, the one next to it | 5
line | please hand over the dish | 3
line | everything is wrong, i want the bowl | 3
line | the red mug that is not next to the bowl | 0
line | not the bowl, the green one | 1
line | the mug; ?2; no; ?1; no | 0
line | the mug; ?2; nah, the one next to it, the green one | 1
line | the leftmost one, from my perspective | 0
line | from where i sit, the rightmost mug | 2
line | the mug second from my left | 1
line | the mug farthest from the bowl, please | 0
line | the red mug; ?0; no; actually the bowl | 3
line | the beaker between the other two red beakers | 1
line | a crimson beaker next to the white bowl | 2
line | the mug; ?0; no not this one, the green one | 1
line | the bowl; ?3; yep, that's it | 3
line | the last one from my left | 3
line | my right; no i mean my left | 0
line | the mugs are all mine, but i want the green one | 1
line | green | 1
line | whichever is white | 3
room | the pan | 6
room | the pan; ?6; yeah | 6
room | the plate behind the pan as i see it | 5
room | the bowl all on its own | 3
room | look at the three bowls on my right and take the middle one | 1
room | the bowl on your far right | 3
room | the plate that is closer to me | 4
room | bowl; ?1; no, the one by itself | 3
room | the saucer closest to you | 5
room | the nearest plate to me | 4
room | the bowl in the center of the row of three | 1
room | a white plate; ?5; no; ?4; yes | 4
room | the isolated blue bowl | 3
room | i want a bowl, but not one of those three in the row | 3
room | the dish close to the skillet | 3
kitchen | the ladle... no wait, the spoon | 2
kitchen | something i can drink from; ?4; no | 5
kitchen | the cup next to the bottle | 5
kitchen | the cup in the back on the left | 4
kitchen | the leftmost apple | 0
kitchen | the fruit next to the spoon | 1
kitchen | the bottle; ?6; correct | 6
kitchen | the thing between the white cup and... no, the bottle | 6
kitchen | the fork or no, the knife | 7
kitchen | third from the left in the front row | 2
kitchen | the mug that isn't blue | 5
kitchen | the red apple; ?0; yes, that one | 0
kitchen | a utensil left of the fork | 2
kitchen | the knife on the right | 7
kitchen | the green one | 1
kitchen | the cup on your left | 4
"""
