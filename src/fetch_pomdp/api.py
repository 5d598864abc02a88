"""The names of the library; `fetch_pomdp` loads this module when one of them is first asked for."""

from fetch_pomdp.core.action import Action, Pick, Point, Wait
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.belief import Belief
from fetch_pomdp.core.bounding.bounds import Bound, upper_bound
from fetch_pomdp.core.events import Acted, Event, Observed
from fetch_pomdp.core.evidence import Evidence
from fetch_pomdp.core.explain import explain
from fetch_pomdp.core.explanation import Explanation
from fetch_pomdp.core.generative import State, step
from fetch_pomdp.core.gesture import Ray
from fetch_pomdp.core.interaction import Timing, interact
from fetch_pomdp.core.language.reading.reader import TableReader
from fetch_pomdp.core.live.person import live_scene
from fetch_pomdp.core.model import Model, Rewards
from fetch_pomdp.core.observation import Observation
from fetch_pomdp.core.planners.base import Decision, Planner, decide_many
from fetch_pomdp.core.planners.baselines.paradigms import AlwaysAsk, NeverAsk
from fetch_pomdp.core.planners.baselines.rules import PaperAlwaysAsk
from fetch_pomdp.core.planners.baselines.searches import PaperNeverAsk
from fetch_pomdp.core.planners.fitted.planner import FittedValue
from fetch_pomdp.core.planners.search.planner import ExactAnswers, SparseSampling
from fetch_pomdp.core.planners.thresholds import Threshold, tuned
from fetch_pomdp.core.ports import Failure, Frame, Outcome, Recognizer, Robot, SkeletonSource, Word
from fetch_pomdp.core.problem import Problem
from fetch_pomdp.core.scene import Item, Scene
from fetch_pomdp.core.simulation import Summary, simulate
from fetch_pomdp.errors import FetchPomdpError, InputError, MissingExtraError

__all__ = [
    "Acted",
    "Action",
    "Agent",
    "AlwaysAsk",
    "Belief",
    "Bound",
    "Decision",
    "Event",
    "Evidence",
    "ExactAnswers",
    "Explanation",
    "Failure",
    "FetchPomdpError",
    "FittedValue",
    "Frame",
    "InputError",
    "Item",
    "MissingExtraError",
    "Model",
    "NeverAsk",
    "Observation",
    "Observed",
    "Outcome",
    "PaperAlwaysAsk",
    "PaperNeverAsk",
    "Pick",
    "Planner",
    "Point",
    "Problem",
    "Ray",
    "Recognizer",
    "Rewards",
    "Robot",
    "Scene",
    "SkeletonSource",
    "SparseSampling",
    "State",
    "Summary",
    "TableReader",
    "Threshold",
    "Timing",
    "Wait",
    "Word",
    "decide_many",
    "explain",
    "interact",
    "live_scene",
    "simulate",
    "step",
    "tuned",
    "upper_bound",
]
