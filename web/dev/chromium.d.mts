/** What checks in a browser use of it. */
export const launchOptions: { executablePath: string; args: string[] };
