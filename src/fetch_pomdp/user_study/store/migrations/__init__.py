"""How the database grew: a revision for each change of its tables, run one after the other by Alembic."""
