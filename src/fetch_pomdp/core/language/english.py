"""How speakers of English answer a robot that points at an item and asks "this one?"."""

from __future__ import annotations

from collections.abc import Mapping

from fetch_pomdp.core.language.phrases import Entry, When
from fetch_pomdp.core.language.words import Meaning, tokenize

ENGLISH: Mapping[Entry, str] = {
    Entry(Meaning.YES): """
        yes, yeah, sure, yup, yep, yea, ya, yah, yass, yessir, yes sir, yes ma'am, yes please, yeah please,
        yep please, sure please, yes it is, yes that's it, yes that one, yes this one, yes that's the one,
        yeah that one, yeah that's it, uh-huh, mm-hmm, mhm, mmhm, mhmm, mmhmm, mm-hm, mhm-hm, uhum, aha,
        ah-hah, affirmative, absolutely, definitely, indeed, not wrong, not bad, sure is, sure thing, for
        sure, of course, of course yes, oh yes, oh yeah, hell yes, hell yeah, why not, you bet, you betcha,
        you got it, you've got it, not the other one, not the other, not that other one, yes not the other
        one
    """,
    Entry(Meaning.NO): """
        no, nope, other, not, nah, naw, nay, noo, uh-uh, nuh-uh, mm-mm, hm-mm, negative, no way, no sir, no
        ma'am, hell no, oh no, god no, no thanks, no thank you, no it's not, no it isn't, no that's not it,
        no not that one, not that, not that one, not this, not this one, not it, not the one, not quite, not
        really, not exactly, not at all, not correct, not right, not quite right, not the right one, not the
        correct one, not what i want, not what i wanted, not what i meant, not what i asked for, that's not
        it, it's not, this is not it, that's not the one, this is not the one, that's not right, that's not
        correct, that's not that, of course not, absolutely not, definitely not, certainly not, please no,
        please not, the other one, the other one please, no the other one, not even close, no other
    """,
    Entry(Meaning.UNSURE): """
        i don't know, don't know, dunno, i dunno, i do not really know, i don't really know, i wouldn't
        know, no idea, i have no idea, no clue, i have no clue, not sure, i'm not sure, i am really not
        sure, not so sure, not too sure, not really sure, not quite sure, i'm not so sure, not certain, i'm
        not certain, unsure, i'm unsure, can't tell, i can't tell, can't say, i can't say, hard to say, hard
        to tell, i can't see it, can't see it, no preference, i don't mind, don't mind, i don't care, don't
        care, doesn't matter, it doesn't matter, either one, either is fine, either way, whichever, i'm not
        sure which one, i don't know which one
    """,
    Entry(Meaning.UNSURE, When.ALONE): """
        maybe, perhaps, possibly, could be, might be, either, any, any one, any of them, whatever, both,
        kind of, sort of, i guess, idk, who knows
    """,
    Entry(Meaning.YES, When.ASKED): """
        correct, that's correct, that is absolutely correct, quite correct, exactly, exactly that one,
        precisely, that's it, that's it exactly, this is it, there it is, that's the one, this is the one,
        that'd be the one, that's the right one, that's the correct one, that's right, quite right, you're
        right, right you are, that'll do, that will do, that works, that does it, that's the one i want,
        that's the one i meant, the one i meant, that's what i want, that's what i wanted, that's what i
        meant, that's mine, go ahead, go for it, go on then, do it, take it, grab it, hand it over, give it
        to me, i'll take it, i think so, i believe so, i guess so, i suppose so, looks right, that looks
        right, sounds good, bingo, bullseye, spot on, well done, good job, good robot, that one exactly,
        that very one, totally, certainly, true, by all means, be my guest
    """,
    Entry(Meaning.YES, When.ALONE): """
        right, okay, ok, okey, okey-dokey, o k, k, kay, alright, all right, fine, that's fine, good, very
        good, great, perfect, excellent, nice, cool, wonderful, lovely, super, brilliant, wow, that one,
        this one, that, this, that one there, that one please, this one please, that one yes, it is, it's
        that one, it's this one, i want it, i want that, i want that one, i want this one, i'll take that
        one, i'll take this one, got it, good one, roger, check, aye, the one, that's good, that's okay,
        that's great, that's perfect, that's all right
    """,
    Entry(Meaning.NO, When.ASKED): """
        incorrect, that's incorrect, wrong one, the wrong one, that's wrong, that's the wrong one, wrong
        item, wrong thing, it's the other one, it's another one, that's another one, i don't want it, i
        don't want that, i don't want that one, i don't want this, i don't want this one, i didn't mean
        that, i didn't mean that one, don't want that, don't want it, try again, try another, try another
        one, guess again, false, nothing like it, that isn't it, this isn't it, that isn't the one, it
        isn't, that isn't right, i don't think so, don't think so, neither, neither one, neither of them,
        neither of those, neither of these, none, none of them, none of those, none of these, another one, a
        different one
    """,
    Entry(
        Meaning.NO, When.ALONE
    ): "wrong, bad, bad robot, n, something else, close, almost, nearly, far from it, next one",
    Entry(Meaning.REPEAT): """
        pardon, pardon me, i beg your pardon, beg your pardon, come again, say again, say that again, say it
        again, can you say that again, could you say that again, can you repeat that, could you repeat that,
        repeat that, please repeat, please repeat that, repeat please, i didn't hear you, i didn't hear
        that, i didn't catch that, didn't catch that, what did you say, what was that, excuse me what, sorry
        what, which one do you mean, what do you mean, i don't understand, i didn't understand, i didn't get
        that
    """,
    Entry(Meaning.REPEAT, When.ALONE): """
        what, sorry, excuse me, huh, which one, which, repeat, again
    """,
    Entry(Meaning.CANCEL): """
        never mind, nevermind, nvm, forget it, forget about it, forget that, cancel, cancel that, leave it,
        leave it be, i don't need it anymore, i don't need it any more, i don't need anything, i've changed
        my mind, i changed my mind, let it be, drop the whole thing, don't bother, no need, not needed, i'm
        done, that's all thanks, abort
    """,
    Entry(Meaning.CANCEL, When.ALONE): """
        nothing, nothing thanks, that's all, that is all, enough, skip it, skip
    """,
    Entry(Meaning.OBJECT): """
        stop, stop it, stop that, please stop, halt, freeze, wait, wait a minute, wait a second, wait a
        moment, hold on, hold it, hang on, put it back, put that back, put it down, put that down,
        let go, let go of it, don't, don't do that, don't do it, do not, don't take that, don't take that
        one, don't take it, don't pick that, don't pick that one, don't give me that, don't give me that
        one, not so fast, not yet, whoa, drop it
    """,
    Entry(None): """
        don't worry, no problem, no problems, no worries, no rush, no hurry, no doubt, no matter, not to
        worry, no one, are you sure, make sure, isn't it, isn't that right, am i right, each other, other
        than that, i'm sorry, if not, or not, whether or not, not only, say no more, on the other hand,
        every other
    """,
}
HESITATIONS = frozenset(tokenize("um umm uh uhm er erm eh ehm em hm hmm mm ah oh m"))
# What may stand around an answer that is said alone.
AROUND = frozenset(
    tokenize("well so please thanks thank you and but then now actually robot hey really very much cheers bye goodbye")
)
# With these "the other one" asks for another item, and does not deny the one that was handed over.
REQUESTS = frozenset(tokenize("give hand get bring pass fetch want need like also too and now next"))
OTHERS = frozenset(tokenize("other another"))
DETERMINERS = frozenset(
    tokenize("the a an that this these those my your his her its our their some any which on to in at")
)
NOUNS = frozenset(tokenize("one ones thing item side corner"))
NEGATORS = frozenset(tokenize("not isnt wasnt aint arent"))
FOLLOWERS = frozenset(tokenize("on next in at with near by behind beside under above below left right to of"))
ADVERBS = frozenset(tokenize("quite really so the exactly"))  # between a negator and what it denies
# Words that say no by themselves, and before more words belong to these.
DESCRIBING = frozenset({"not", "other", "another"})
