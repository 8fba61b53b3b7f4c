"""A tree of results: is it what the run wrote, and how does it differ from another one?"""
