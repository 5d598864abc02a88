"""The README's example: an agent hears a request, asks, and picks."""

from fetch_pomdp import Agent, Pick, Point

agent = Agent("ambiguous")
agent.observe("hand me the green marker", head=(0, 0, 1.6), wrist=(-0.01, 0.5, 1.47))
while not isinstance(action := agent.act(), Pick):
    if isinstance(action, Point):
        print("this one?", agent.item(action).id)  # and your robot points at it
    agent.observe("no" if isinstance(action, Point) else "")
print("here you are:", agent.item(action).id, agent.belief.round(2))
