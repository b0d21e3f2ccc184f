### Gründe, aus denen Aufträge endeten.
