"""Programs that write what is kept in the repository: examples' data, the numbers of docs."""
