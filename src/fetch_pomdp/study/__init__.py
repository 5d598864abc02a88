"""User studies: simulated people, experiments, their analysis, and the fit of parameters to what people did."""
