"""How speakers of German answer a robot that points at an item and asks "this one?"."""

from __future__ import annotations

from collections.abc import Mapping

from fetch_pomdp.core.language.phrases import Entry, When
from fetch_pomdp.core.language.words import Meaning, tokenize

GERMAN: Mapping[Entry, str] = {
    Entry(Meaning.YES): """
        ja, jaa, jo, joa, jep, jepp, jup, jawohl, jawoll, ja bitte, ja genau, ja klar, ja das da, ja den da,
        ja die da, ja das ist es, ja der, ja gerne, ja gern, na klar, aber ja, aber klar, oh ja, ach ja,
        klar doch, genau, ganz genau, genau das, genau den, genau die, genau der, genau das da, genau den
        da, genau die da, stimmt, das stimmt, stimmt genau, nicht falsch, nicht schlecht, freilich,
        selbstverständlich, natürlich, absolut, unbedingt, auf jeden fall, nicht den anderen, nicht die
        andere, nicht das andere
    """,
    Entry(Meaning.NO): """
        nein, nee, ne, nö, nöö, naa, nein danke, nee danke, ach nein, oh nein, aber nein, nein nicht das,
        nein nicht der, nein nicht die, nein nicht den, nicht das, nicht der, nicht die, nicht den, nicht
        dieser, nicht diese, nicht dieses, nicht diesen, nicht das da, nicht der da, nicht die da, nicht den
        da, das nicht, der nicht, die nicht, den nicht, das da nicht, die da nicht, der da nicht, den da
        nicht, das ist es nicht, das ist er nicht, das ist sie nicht, der ist es nicht, die ist es nicht,
        ist es nicht, ist er nicht, ist sie nicht, stimmt nicht, das stimmt nicht, nicht richtig, das ist
        nicht richtig, nicht ganz, nicht wirklich, nicht genau, passt nicht, das passt nicht, keins, keines,
        keiner, keine, keinen, keins von beiden, keines von beiden, keiner von beiden, keine von beiden,
        keins davon, keiner davon, keine davon, keinesfalls, auf keinen fall, ganz und gar nicht, überhaupt
        nicht, gar nicht, natürlich nicht, eher nicht, doch nicht, lieber nicht, bitte nicht, glaube nicht,
        ich glaube nicht, glaub nicht, ich glaub nicht, nein den anderen, nein die andere, nein das andere,
        nein der andere
    """,
    Entry(Meaning.YES, When.ASKED): """
        richtig, ganz richtig, das ist richtig, korrekt, das ist korrekt, exakt, passt, das passt, passt so,
        das ist es, das ist er, das ist sie, das ist das richtige, das ist der richtige, das ist die
        richtige, der ist es, die ist es, das wäre es, das wärs, den meine ich, die meine ich, das meine
        ich, den meinte ich, die meinte ich, das meinte ich, den will ich, die will ich, das will ich, den
        möchte ich, die möchte ich, das möchte ich, den nehme ich, die nehme ich, das nehme ich, gib her,
        her damit, nur zu, mach das, ich glaube schon, glaub schon, ich denke schon, sieht gut aus, treffer,
        volltreffer, wunderbar, einverstanden, in ordnung, alles klar
    """,
    Entry(Meaning.YES, When.ALONE): """
        das, den, die, der, das da, den da, die da, der da, das hier, den hier, die hier, der hier, dieses,
        diesen, diese, dieser, das dort, den dort, die dort, dieses da, diesen da, diese da, dieser da,
        klar, sicher, gut, sehr gut, gerne, gern, okay, ok, prima, perfekt, super, toll, bestens, schön,
        eben, recht so
    """,
    Entry(Meaning.NO, When.ASKED): """
        den anderen, die andere, das andere, der andere, ein anderer, einen anderen, eine andere, ein
        anderes, falsch, das ist falsch, ganz falsch, der falsche, die falsche, das falsche, den falschen,
        das ist der falsche, das ist die falsche, das ist das falsche, will ich nicht, das will ich nicht,
        den will ich nicht, die will ich nicht, meine ich nicht, das meine ich nicht, den meine ich nicht,
        die meine ich nicht, der daneben, die daneben, das daneben, den daneben, woanders, etwas anderes,
        was anderes
    """,
    Entry(Meaning.NO, When.ALONE): """
        andere, anderer, anderes, anderen, nicht, fast, beinahe, knapp daneben, knapp
    """,
    Entry(Meaning.UNSURE): """
        weiß nicht, ich weiß nicht, weiß ich nicht, das weiß ich nicht, ich weiß es nicht, weiß es nicht,
        keine ahnung, ich habe keine ahnung, hab keine ahnung, ich hab keine ahnung, nicht sicher, ich bin
        nicht sicher, bin nicht sicher, ich bin mir nicht sicher, bin mir nicht sicher, unsicher, schwer zu
        sagen, kann ich nicht sagen, egal, ist egal, mir egal, das ist egal, ist mir egal, das ist mir egal,
        ganz egal, völlig egal, eins von beiden, einer von beiden, eine von beiden
    """,
    Entry(
        Meaning.UNSURE, When.ALONE
    ): "vielleicht, eventuell, womöglich, kann sein, könnte sein, mal sehen, beide, beides, irgendeins",
    Entry(Meaning.REPEAT): """
        wie bitte, was bitte, bitte was, noch mal bitte, nochmal bitte, noch einmal bitte, bitte nochmal,
        bitte noch mal, bitte noch einmal, sag das nochmal, sag das noch mal, wiederhole das, wiederholen
        bitte, bitte wiederholen, was hast du gesagt, was war das, was meinst du, ich habe dich nicht
        verstanden, habe ich nicht verstanden, ich habe das nicht verstanden, nicht verstanden, ich verstehe
        nicht, verstehe ich nicht
    """,
    Entry(
        Meaning.REPEAT, When.ALONE
    ): "was, hä, häh, welcher, welche, welches, welchen, nochmal, noch mal, noch einmal, wer, entschuldigung",
    Entry(Meaning.CANCEL): """
        schon gut, vergiss es, vergiss das, lass es sein, lass gut sein, lass mal, nicht mehr nötig, nicht
        nötig, hat sich erledigt, erledigt, abbrechen, abbruch, brauche ich nicht mehr, brauch ich nicht
        mehr, ich brauche nichts, ach nichts, nichts für ungut
    """,
    Entry(Meaning.CANCEL, When.ALONE): """
        nichts, nichts danke, danke das war alles, das war alles, genug
    """,
    Entry(Meaning.OBJECT): """
        stopp, halt stopp, warte, warte mal, warte kurz, moment, moment mal, einen moment, halt an, halt
        ein, anhalten, aufhören, hör auf, leg es zurück, leg das zurück, leg ihn zurück, leg sie zurück, leg
        es weg, leg das hin, leg es hin, stell es zurück, stell das zurück, stell es hin, zurücklegen, lass
        los, loslassen, finger weg, nimm das nicht, nimm den nicht, nimm die nicht, nicht so schnell, noch nicht
    """,
    Entry(None): """
        nicht wahr, oder nicht, kein problem, keine sorge, keine eile, keine ursache, bist du sicher, ja
        oder nein, ob oder nicht, wenn nicht, nicht nur
    """,
}
HESITATIONS = frozenset(tokenize("aeh aehm oeh oehm ae oe ach och"))
REQUESTS = frozenset(tokenize("gib hol bring reich will moechte brauche auch und jetzt noch"))
OTHERS = frozenset(tokenize("andere anderen anderer anderes"))
AROUND = frozenset(tokenize("also na naja tja bitte danke dann und aber jetzt mal so roboter schoen nun doch du sehr"))
DETERMINERS = frozenset(
    tokenize(
        "der die das den dem des ein eine einen einem einer eines mein meine meinen auf im am zum zur rechts links"
    )
)
NOUNS = frozenset(tokenize("teil ding seite ecke"))
NEGATORS = frozenset(tokenize("nicht kein keine"))
FOLLOWERS = frozenset(tokenize("neben hinter vor mit auf unter ueber bei links rechts von im am"))
ADVERBS = frozenset(tokenize("ganz wirklich so genau der die das den"))
# Words that say no by themselves, and before more words belong to these.
DESCRIBING = frozenset({"nicht", "andere", "anderen", "anderer", "anderes"})
