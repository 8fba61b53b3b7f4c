"""A look at a corpus before it is analysed: what is suspicious, and what to do first."""
