"""Statistics of arrays and data frames; nothing here knows a recording."""
