// What our pages use of @fluent/bundle.

export type Pattern = string | unknown[];

export class FluentResource {
  constructor(source: string);
}

export class FluentBundle {
  constructor(
    locales: string | string[],
    options?: {
      functions?: Record<string, (given: unknown[], named: Record<string, unknown>) => unknown>;
      useIsolating?: boolean;
    },
  );
  hasMessage(id: string): boolean;
  getMessage(id: string): { value: Pattern | null } | undefined;
  addResource(resource: FluentResource): Error[];
  formatPattern(pattern: Pattern, values?: Record<string, string | number>): string;
}
