"""The problem in the forms that planning and learning libraries take."""
